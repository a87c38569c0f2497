# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""Guess of each scan's pose, from `ekf_pose_with_covariance`."""

from __future__ import annotations

from collections import deque
from statistics import median

from rmw_manycore_py.ndt.geometry import poses
from rmw_manycore_py.ndt.geometry.arrays import Matrix
from rmw_manycore_py.ndt.nodes.scan_matcher.pose_buffer import (
    Interpolated,
    NoPoseError,
    PoseBuffer,
)

MAX_AGE_PERIODS = 1.5  # maximum age of the newest guess: previous scan plus some delay
FIRST_PERIOD_S = 0.1  # assumed scan period before the second scan
PERIODS = 9  # number of intervals in the median of the period
MOTION_S = 0.4  # time over which motion is estimated, if guesses reach back
MIN_MOTION_S = 0.05  # half a period of most LiDARs
KEPT_S = 1.0  # age of guesses kept for motion estimates
JUMP_M, MAX_SPEED_M_S = 2.0, 60.0  # of a vehicle; corrections of guesses are smaller


class Guesses:
    """Buffer of guesses that interpolates the guess at a scan's time.

    :param timeout_s: maximum time between a scan and a guess, for any scan period.
    :param distance_tolerance_m: maximum distance between interpolated guesses.
    :param newest_holds: use the newest guess unchanged up to `timeout_s`, as Autoware does.
    """

    def __init__(self, timeout_s: float, distance_tolerance_m: float, newest_holds: bool) -> None:
        self._buffer = PoseBuffer(timeout_s, distance_tolerance_m)
        self._newest_holds = newest_holds
        self._periods_s: deque[float] = deque(maxlen=PERIODS)
        self._period_s = FIRST_PERIOD_S
        self._last_scan_s: float | None = None

    def push(self, stamp_s: float, T: Matrix) -> None:
        """Add a guess. Thread-safe."""
        self._buffer.push(stamp_s, T)

    def clear(self) -> None:
        """Remove all guesses. Thread-safe."""
        self._buffer.clear()

    def is_there(self, stamp_s: float) -> bool:
        """Return whether the guess for a scan is available. Thread-safe."""
        return self._newest_holds or self._buffer.reaches(stamp_s)

    def note_scan(self, stamp_s: float) -> None:
        """Record the stamp of each arriving scan: their period bounds the age of guesses."""
        if self._last_scan_s is not None and stamp_s > self._last_scan_s:
            self._periods_s.append(stamp_s - self._last_scan_s)
            self._period_s = median(self._periods_s)
        self._last_scan_s = stamp_s

    def motion_until(self, stamp_s: float, T: Matrix) -> tuple[Matrix, float] | None:
        """Return the motion (4, 4) up to a pose at a time, and its duration; None if unknown.

        If guesses follow results, a correction makes the next guess jump, which would count as
        motion; averaging over several periods reduces its effect. A guess that no vehicle reaches
        from the one before it begins a new drive: the motion before it is ignored.
        """
        drive = self._buffer.drive_until(stamp_s, stamp_s - KEPT_S, JUMP_M, MAX_SPEED_M_S)
        old = [guess for guess in drive if guess.stamp_s <= stamp_s - MOTION_S]
        before = old[-1] if old else next(iter(drive), None)
        if before is None or stamp_s - before.stamp_s < MIN_MOTION_S:
            return None
        return poses.inverse(before.T) @ T, stamp_s - before.stamp_s

    def at(self, stamp_s: float) -> Interpolated:
        """Return the guess at a scan's time; raises NoPoseError."""
        if self._newest_holds:
            guess = self._buffer.newest_at(stamp_s)
            if guess is None:
                raise NoPoseError("there are no two poses near it, without a jump between them")
            self._buffer.forget_before(stamp_s)
            return guess
        guess = self._buffer.at(stamp_s, MAX_AGE_PERIODS * self._period_s)
        self._buffer.forget_before(stamp_s, KEPT_S)
        return guess
