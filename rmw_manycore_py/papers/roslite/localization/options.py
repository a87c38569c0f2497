# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""Options of the localizer: voxels of Autoware.AI's ndt_matching, and one level."""

from __future__ import annotations

from rmw_manycore_py.ndt.matching.options import MatcherOptions

OPTIONS = MatcherOptions(voxel_size_m=1.0, coarse_levels=(), wide_levels=())
# Tiles hold whole voxels.
TILE_M = 16.0
