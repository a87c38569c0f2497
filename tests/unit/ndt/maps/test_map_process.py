# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""A sample of the tiles is small, and leaves nothing in the process that builds maps."""

from __future__ import annotations

import pytest

from rmw_manycore_py.ndt.maps import map_process
from rmw_manycore_py.ndt.maps.map_tiles import TileFiles

pytestmark = pytest.mark.unit

HEAD = """VERSION 0.7
FIELDS x y z
SIZE 4 4 4
TYPE F F F
COUNT 1 1 1
WIDTH 500
HEIGHT 1
VIEWPOINT 0 0 0 1 0 0 0
POINTS 500
DATA ascii
"""


def test_a_sample_is_spread_over_all_tiles_and_none_is_kept(tmp_path):
    tiles = tuple(tmp_path / f"{name}.pcd" for name in "ab")
    for number, tile in enumerate(tiles):
        tile.write_text(HEAD + f"{number} 0 0\n" * 500)
    sample = map_process.sample_of(TileFiles(tiles, leaf_m=0.0), 10)
    assert sample[:, 0].tolist() == [0.0] * 5 + [1.0] * 5
    assert map_process._tiles == {}
