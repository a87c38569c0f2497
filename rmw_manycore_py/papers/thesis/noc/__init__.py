# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""Data transfers between memories of clusters, as in section 4.1 of Maruyama's thesis."""
