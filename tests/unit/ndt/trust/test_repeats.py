# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""Old scans with new stamps are noticed by guesses that move."""

from __future__ import annotations

import numpy as np
import pytest

from rmw_manycore_py.ndt.geometry.poses import from_xyz_rpy
from rmw_manycore_py.ndt.trust.motion import MotionModel
from rmw_manycore_py.ndt.trust.repeats import RepeatedScans

pytestmark = pytest.mark.unit

SPEED_M, PERIOD_S = 0.4, 0.1  # per scan
SCAN = np.random.default_rng(1).normal(size=(50, 3)).astype(np.float32)
NEW = 5  # scans of a drive, before the sensor repeats


def at(x: float) -> np.ndarray:
    return from_xyz_rpy((x, 0.0, 0.0))


def refused_after(
    scans: int, step_m: float, *, is_closed_loop: bool, noise_m: float = 0.0, new: int = NEW
) -> int:
    """Return the number of repeated scans until one is refused; 0 if none of these many is.

    :param new: scans before, in which the vehicle drives.
    """
    motion, repeats = MotionModel(), RepeatedScans()
    generator = np.random.default_rng(2)
    x = 0.0
    for index in range(new + scans):
        is_new = index < new
        x += step_m if is_new else 0.0
        ahead = (0 if is_new else 1) if is_closed_loop else max(index - new + 1, 0)
        guess = at(x + step_m * ahead)
        moved = SCAN + (index if is_new else new - 1)
        points = (moved + generator.normal(scale=noise_m, size=SCAN.shape)).astype(np.float32)
        expected = motion.at(index * PERIOD_S, guess)
        if "repeats an old scan" in repeats.why_refused(points, expected):
            return index - new + 1
        motion.believe(index * PERIOD_S, at(x), guess)
    return 0


@pytest.mark.parametrize("is_closed_loop", [True, False])
def test_repeated_scans_are_refused_once_the_guesses_moved_a_metre(is_closed_loop):
    assert 2 <= refused_after(20, SPEED_M, is_closed_loop=is_closed_loop) <= 4


def test_scans_of_a_vehicle_that_stands_are_not_refused():
    assert refused_after(20, 0.0, is_closed_loop=False) == 0
    assert refused_after(20, SPEED_M, is_closed_loop=True, noise_m=0.01) == 0


def test_guesses_that_stay_beside_the_pose_of_a_vehicle_that_stands_are_no_motion():
    assert refused_after(200, SPEED_M, is_closed_loop=True, new=0) == 0
