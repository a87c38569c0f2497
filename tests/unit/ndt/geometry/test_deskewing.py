# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""A scan taken while the sensor moves is transformed to a single moment."""

from __future__ import annotations

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


def test_the_number_type_is_kept():
    motion = poses.from_xyz_rpy((1.0, 0.0, 0.0))
    assert deskewed(PLACES.astype(np.float32), SHARES, motion).dtype == np.float32
