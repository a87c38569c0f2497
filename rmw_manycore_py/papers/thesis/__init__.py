# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""The thesis on the NoC of the MPPA-256: its measurements on this machine, and on a model."""
