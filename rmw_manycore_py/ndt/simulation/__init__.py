# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""Simulation of a LiDAR driven along a synthetic street."""
