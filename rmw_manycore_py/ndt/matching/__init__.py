# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""Scan matcher: options, voxel map, serial and worker matchers, results."""
