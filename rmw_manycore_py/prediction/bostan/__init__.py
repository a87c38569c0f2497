# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""A discrete-event model of Kalray's MPPA-256 Bostan: its data NoC, DMA engines and memories."""
