# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""The errors of three poses of each scan, from the distances between them."""

from __future__ import annotations

import numpy as np
import pytest

from rmw_manycore_py.bench.ndt import accuracy, refined
from rmw_manycore_py.bench.ndt.accuracy import own_error_cm
from rmw_manycore_py.bench.summary import Result, judge
from rmw_manycore_py.ndt.simulation.drive import poses_along, scans_along
from rmw_manycore_py.ndt.simulation.lidar import Lidar
from rmw_manycore_py.ndt.simulation.street import build_street

pytestmark = pytest.mark.unit


def test_the_error_of_each_is_distinguished_from_the_others():
    generator = np.random.default_rng(1)
    truth = generator.uniform(-50.0, 50.0, (4000, 3))
    errors_cm = (1.0, 2.0, 3.0)  # root mean squares
    found = [
        truth + generator.normal(scale=0.01 * cm / np.sqrt(3), size=(4000, 3)) for cm in errors_cm
    ]
    found[0][:5] += 3.0  # scans that were not found do not count
    for index, expected_cm in enumerate(errors_cm):
        others = [places for other, places in enumerate(found) if other != index]
        assert own_error_cm(found[index], *others) == pytest.approx(expected_cm, rel=0.1)


def test_errors_on_recordings_have_the_goal_of_streets():
    found = [
        Result(accuracy.OFF_EXACT, accuracy.OWN, "cm", (0.3,)),
        Result(accuracy.OFF_REFERENCE, accuracy.OWN, "cm", (2.2,)),
    ]
    reached = {one.goal.question: one.reached for one in judge(found, accuracy.QUESTION.goals)}
    assert reached == {accuracy.OFF_EXACT: True, accuracy.OFF_REFERENCE: False}


def test_references_that_are_off_are_refined_and_thicker():
    """Of a street whose poses are exact, 5 cm off: refined they are nearer than half of that."""
    generator = np.random.default_rng(2)
    exact = poses_along(np.arange(0.0, 12.0, 1.0))
    lidar = Lidar(rings=16, azimuths=360)
    scans = list(scans_along(build_street(12.0, generator), exact, lidar, generator))
    off = exact.copy()
    off[:, :3, 3] += generator.normal(scale=0.05, size=(len(exact), 3))
    found = refined.refined_poses(scans, off)
    thick, thin = (np.median(refined.thicknesses_cm(refined.cloud(scans, T))) for T in (off, found))
    assert thin < 0.8 * thick
    assert spread_m(found, exact) < 0.5 * spread_m(off, exact)


def spread_m(T: np.ndarray, exact: np.ndarray) -> float:
    """Return the errors of positions, without what is common to all: maps may be moved as one."""
    errors = T[:, :3, 3] - exact[:, :3, 3]
    return float(np.linalg.norm(errors - errors.mean(axis=0), axis=1).mean())
