# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""The part of a map around a vehicle."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

from rmw_manycore_py.errors import ManycoreError
from rmw_manycore_py.ndt.maps import map_area
from rmw_manycore_py.ndt.maps.map_area import MapArea
from rmw_manycore_py.ndt.maps.map_tiles import open_map, write_tiles

pytestmark = pytest.mark.unit


@pytest.fixture
def area(tmp_path: Path) -> MapArea:
    points = np.random.default_rng(1).uniform((0, 0, 0), (200, 20, 5), (20000, 3)).astype("f4")
    write_tiles(tmp_path, points, 20.0, ".npz")
    return MapArea(open_map(tmp_path), radius_m=22.0, update_distance_m=5.0)


def test_an_area_is_loaded_again_only_where_other_tiles_are_needed(area: MapArea):
    assert area.distance_m(50.0, 10.0) == np.inf
    first = area.update(50.0, 10.0)
    assert area.distance_m(50.0, 10.0) == np.inf  # not in use yet
    area.accept(area.asked)
    assert (first[:, 0].min() > 19.9, first[:, 0].max() < 80.1) == (True, True)
    assert area.update(54.0, 10.0) is None
    assert area.update(56.0, 10.0) is None
    assert area.distance_m(56.0, 10.0) == 0.0
    moved = area.update(90.0, 10.0)
    assert moved[:, 0].min() > 59.9
    assert area.distance_m(56.0, 10.0) == 0.0


def test_refused_tiles_are_asked_for_again_but_not_at_once(area: MapArea, monkeypatch):
    first = area.update(50.0, 10.0)
    area.refuse()
    assert area.update(54.0, 10.0) is None
    np.testing.assert_array_equal(area.update(56.0, 10.0), first)
    monkeypatch.setattr(map_area, "RETRY_S", 0.0)
    area.refuse()
    np.testing.assert_array_equal(area.update(56.0, 10.0), first)
    assert area.update(56.0, 10.0) is None  # until it is refused again


def test_refused_tiles_leave_those_in_use(area: MapArea):
    area.update(50.0, 10.0)
    area.accept(used := area.asked)
    area.update(130.0, 10.0)
    area.refuse()
    assert area.loaded == used
    assert area.distance_m(50.0, 10.0) == 0.0
    assert area.update(50.0, 10.0) is None


def test_the_files_of_an_area_are_named_for_another_process(area: MapArea):
    area.update(90.0, 10.0)
    area.accept(area.asked)
    files = area.update_files(130.0, 10.0)
    assert files.read({})[:, 0].min() > 99.9
    assert area.update_files(131.0, 10.0) is None


def test_tiles_that_cannot_be_read_are_asked_for_again(tmp_path, monkeypatch):
    points = np.random.default_rng(1).uniform((0, 0, 0), (40, 20, 5), (2000, 3)).astype("f4")
    write_tiles(tmp_path, points, 20.0, ".npz")
    area = MapArea(open_map(tmp_path), radius_m=30.0, update_distance_m=5.0)
    (tmp_path / "0_0.npz").rename(tmp_path / "away")
    monkeypatch.setattr(map_area, "RETRY_S", 0.0)
    with pytest.raises(ManycoreError, match="no such file"):
        area.update(10.0, 10.0)
    (tmp_path / "away").rename(tmp_path / "0_0.npz")
    assert len(area.update(10.0, 10.0)) == len(points)
