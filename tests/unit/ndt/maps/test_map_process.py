# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""A sample of a tile is small, and leaves nothing in the process that builds maps."""

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


def test_a_tile_gives_its_share_and_is_not_kept(tmp_path, monkeypatch):
    monkeypatch.setattr(map_process, "_tiles", {})
    path = tmp_path / "a.pcd"
    path.write_text(HEAD + "".join(f"{number} 0 0\n" for number in range(500)))
    tile = TileFiles((path,), leaf_m=0.0)
    whole, seen = map_process.sample_of(tile, 0, 500)
    assert (len(whole), seen) == (500, 500)
    sample, seen = map_process.sample_of(tile, 1500, 40)
    assert (sample[:, 0] // 50).tolist() == list(range(10))
    assert seen == 2000
    assert map_process._tiles == {}
