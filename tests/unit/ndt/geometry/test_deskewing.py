# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""A scan taken while the sensor moves is transformed to a single moment."""

from __future__ import annotations

from functools import partial

import numpy as np
import pytest

from rmw_manycore_py.ndt.geometry import poses
from rmw_manycore_py.ndt.geometry.deskewing import deskewed

pytestmark = pytest.mark.unit

GENERATOR = np.random.default_rng(1)
PLACES = GENERATOR.uniform(-30.0, 30.0, (200, 3))
SHARES = GENERATOR.uniform(-0.5, 1.5, 200)


@pytest.mark.parametrize("turn_rad", [0.0, 0.3])
def test_points_come_to_where_they_were_at_the_start(turn_rad):
    motion = poses.from_xyz_rpy((1.5, 0.1, 0.0), (0.0, 0.5 * turn_rad, turn_rad))
    seen = np.array(
        [
            poses.transform(
                poses.inverse(poses.interpolate(np.eye(4), motion, share)), place[None]
            )[0]
            for place, share in zip(PLACES, SHARES, strict=True)
        ]
    )
    assert np.abs(seen - PLACES).max() > 0.5
    np.testing.assert_allclose(deskewed(seen, SHARES, motion), PLACES, atol=1e-9)


@pytest.mark.parametrize(("speed_m_s", "turn_rad_s"), [(8.0, 0.25), (15.0, -0.5), (15.0, 1e-7)])
def test_a_vehicle_that_turns_drives_an_arc(speed_m_s, turn_rad_s):
    """The motion of the last 0.4 s tells where the points of the next 0.1 s were seen from."""
    times_s = GENERATOR.uniform(0.0, 0.1, len(PLACES))
    circle = partial(on_a_circle, speed_m_s, turn_rad_s)
    seen = np.array(
        [
            poses.transform(poses.inverse(circle(time_s)), place[None])[0]
            for place, time_s in zip(PLACES, times_s, strict=True)
        ]
    )
    found = deskewed(seen, times_s / 0.4, poses.inverse(circle(-0.4)))
    np.testing.assert_allclose(found, PLACES, atol=1e-7)


def on_a_circle(speed_m_s: float, turn_rad_s: float, time_s: float) -> np.ndarray:
    """Return where a vehicle is that passes the origin at time 0, along x."""
    radius_m, angle = speed_m_s / turn_rad_s, turn_rad_s * time_s
    place = (radius_m * np.sin(angle), 2.0 * radius_m * np.sin(0.5 * angle) ** 2, 0.0)
    return poses.from_xyz_rpy(place, (0.0, 0.0, angle))


def test_the_number_type_is_kept():
    motion = poses.from_xyz_rpy((1.0, 0.0, 0.0))
    assert deskewed(PLACES.astype(np.float32), SHARES, motion).dtype == np.float32
