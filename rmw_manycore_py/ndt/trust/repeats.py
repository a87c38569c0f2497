# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""Notices a sensor that repeats old scans with new stamps: the guesses move, the scans do not.

Noise makes all scans of a real sensor differ. Where nothing moves, as in a simulator whose vehicle
stands, equal scans are no fault.
"""

from __future__ import annotations

import zlib
from collections import deque

import numpy as np

from rmw_manycore_py.ndt.geometry import poses
from rmw_manycore_py.ndt.geometry.arrays import Matrix, Pose, ScanPoints
from rmw_manycore_py.ndt.trust.motion import MOVING_M, SHIFT_M, Expectation

KEPT_SCANS = 100
MOVED_M = 1.0  # that guesses move in all while scans repeat


class RepeatedScans:
    """Compares scans with earlier ones."""

    def __init__(self) -> None:
        self._seen: deque[int] = deque(maxlen=KEPT_SCANS)
        self._before: Expectation | None = None
        self._drives = False  # at the last new scan
        self._by_guesses: Matrix = np.zeros(3)
        self._from_poses: Matrix = np.zeros(3)

    def why_refused(self, points: ScanPoints, expected: Expectation | None) -> str:
        """Return why a scan (N, 3) is refused; "" if it is new, or the guesses stay as well."""
        check = zlib.crc32(np.ascontiguousarray(points).data)
        before, self._before = self._before, expected
        if check not in self._seen:
            self._seen.append(check)
            self._drives = _drives(expected)
            self._by_guesses = self._from_poses = np.zeros(3)
            return ""
        if before is None or expected is None:
            return ""
        self._by_guesses = self._by_guesses + _step_m(before.guess, expected.guess)
        # In a closed loop guesses start at the last pose. So do those of a vehicle that stands, a
        # little beside it.
        if self._drives and expected.last is not before.last:
            self._from_poses = self._from_poses + _step_m(expected.last, expected.guess)
        moved_m = max(float(np.linalg.norm(m)) for m in (self._by_guesses, self._from_poses))
        if moved_m <= MOVED_M:
            return ""
        return f"the sensor repeats an old scan, while the guesses moved by {moved_m:.1f} m"


def _drives(expected: Expectation | None) -> bool:
    if expected is None or expected.by_motion is None:
        return False
    return poses.distance_m(expected.last, expected.by_motion) > MOVING_M


def _step_m(T: Pose | None, guess: Pose | None) -> Matrix:
    """Return how far a guess is away; zero if it jumped."""
    if T is None or guess is None:
        return np.zeros(3)
    step_m: Matrix = guess[:3, 3] - T[:3, 3]
    return step_m if np.linalg.norm(step_m) <= SHIFT_M else np.zeros(3)
