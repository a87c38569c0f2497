# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""Predicts the pose of a scan, like the rest of a laptop's stack."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Protocol

import numpy as np

from rmw_manycore_py.ndt.geometry import poses
from rmw_manycore_py.ndt.geometry.arrays import Matrix
from rmw_manycore_py.ndt.geometry.pose_filter import PoseFilter
from rmw_manycore_py.ndt.recordings.recording import Recording

MEASURED = np.diag([0.0225, 0.0225, 0.0225, 0.000625, 0.000625, 0.000625])  # m^2, rad^2


class Prediction(Protocol):
    """Predicts the pose of each scan in turn, and receives the results."""

    def guess(self, index: int, stamp_s: float) -> Matrix:
        """Return the guess for a scan at a time."""

    def result(self, index: int, stamp_s: float, T_map_sensor: Matrix) -> None:
        """Take the pose found for a scan."""


class Perturbed:
    """The reference pose with a fixed error in random directions."""

    def __init__(self, drive: Recording, offset_m: float, turn_deg: float, seed: int) -> None:
        self._drive = drive
        self._offset_m, self._turn_rad = offset_m, float(np.radians(turn_deg))
        self._generator = np.random.default_rng(seed)

    def guess(self, index: int, stamp_s: float) -> Matrix:  # noqa: ARG002
        """Return a guess, independent of results."""
        reference = self._drive.poses[index]
        return poses.perturbed(reference, self._offset_m, self._turn_rad, self._generator)

    def result(self, index: int, stamp_s: float, T_map_sensor: Matrix) -> None:
        """Ignore the result."""


class Odometry:
    """Closed loop: the last result plus simulated odometry with an error.

    Scans without an answer are bridged with odometry.
    """

    def __init__(self, first_pose: Matrix, motions: Sequence[Matrix]) -> None:
        self._last = (0, first_pose)
        self._motions = motions

    def guess(self, index: int, stamp_s: float) -> Matrix:  # noqa: ARG002
        """Return the last result plus all motion since."""
        since, T = self._last
        for motion in self._motions[since:index]:
            T = T @ motion
        return T

    def result(self, index: int, stamp_s: float, T_map_sensor: Matrix) -> None:  # noqa: ARG002
        """Continue from a pose, if it is newer than the last result."""
        if index >= self._last[0]:
            self._last = (index, T_map_sensor)


class Velocity:
    """Closed loop: the filter of `ekf_localizer` with the results as its only input."""

    def __init__(self, first_pose: Matrix) -> None:
        self._first_pose = first_pose
        self._filter = PoseFilter()

    def guess(self, index: int, stamp_s: float) -> Matrix:  # noqa: ARG002
        """Return the filter's prediction."""
        if not self._filter.is_initialized:
            self._filter.initialize(stamp_s, self._first_pose, MEASURED)
        return self._filter.predicted(stamp_s).pose()

    def result(self, index: int, stamp_s: float, T_map_sensor: Matrix) -> None:  # noqa: ARG002
        """Add a result to the filter."""
        self._filter.add_pose(stamp_s, T_map_sensor, MEASURED)
