# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""The town in which `manycore bench ndt --only lost` looks for scans."""

from __future__ import annotations

import numpy as np
import pytest

from rmw_manycore_py.bench.ndt import lost, town
from rmw_manycore_py.bench.ndt.town import SIDE_M
from rmw_manycore_py.ndt.geometry.arrays import scan_points
from rmw_manycore_py.ndt.geometry.poses import from_xyz_rpy

pytestmark = pytest.mark.unit


def test_the_places_are_on_the_streets_in_all_parts_and_directions():
    built = town.build_town(1)
    poses = town.places(200, np.random.default_rng(3))
    for x, y in poses[:, :2, 3]:
        inside = (built.lower[:, :2] < (x, y)) & (built.upper[:, :2] > (x, y))
        assert not inside.all(axis=1).any()
    parts = {tuple((T[:2, 3] // (SIDE_M / 3)).astype(int)) for T in poses}
    assert len(parts) == 9
    assert len(np.unique(np.sign(poses[:, :2, 0]), axis=0)) == 4


def test_the_ground_of_the_map_is_not_below_houses():
    built = town.build_town(1)
    points = town.survey(built, 1)
    low = points[points[:, 2] < 0.1]
    assert points[:, :2].min() > -20.0
    assert points[:, :2].max() < SIDE_M + 20.0
    house = np.argmax(built.upper[:, 2])
    inside = (low[:, :2] > built.lower[house, :2] + 1.0) & (
        low[:, :2] < built.upper[house, :2] - 1.0
    )
    assert not inside.all(axis=1).any()


def test_a_pose_is_right_within_the_stated_errors():
    truth = from_xyz_rpy((10.0, 20.0, 1.9), (0.01, 0.02, 1.0))
    one = lost.Lost(scan_points(np.zeros((1, 3))), truth)
    assert one.is_at(truth)
    assert not one.is_at(from_xyz_rpy((10.0, 20.4, 1.9), (0.01, 0.02, 1.0)))
    assert not one.is_at(from_xyz_rpy((10.0, 20.0, 1.9), (0.01, 0.02, 1.05)))
    assert np.isinf(one.region().radius_m)
    assert one.region().any_yaw
