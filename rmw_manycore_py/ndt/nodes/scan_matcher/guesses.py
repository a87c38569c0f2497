# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""Where each scan is guessed to be, from `ekf_pose_with_covariance`."""

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

MAX_AGE_PERIODS = 1.5  # of the newest guess: one that belongs to the scan before, with some delay
FIRST_PERIOD_S = 0.1  # of scans, until two have come
PERIODS = 9  # whose median is the period
MOTION_S = 0.4  # that the motion of a scan is seen over, where there are guesses so old
MIN_MOTION_S = 0.05  # half a period of most LiDARs
KEPT_S = 1.0  # guesses before a scan that still tell the motion


class Guesses:
    """Guesses as they arrive, and the guess at a scan's time.

    :param timeout_s: maximum time between a scan and a guess, whatever the period.
    :param distance_tolerance_m: maximum distance between guesses to interpolate between.
    :param newest_holds: use the newest guess up to `timeout_s` as it is, as Autoware does.
    """

    def __init__(self, timeout_s: float, distance_tolerance_m: float, newest_holds: bool) -> None:
        self._buffer = PoseBuffer(timeout_s, distance_tolerance_m)
        self._newest_holds = newest_holds
        self._periods_s: deque[float] = deque(maxlen=PERIODS)
        self._period_s = FIRST_PERIOD_S
        self._last_scan_s: float | None = None

    def push(self, stamp_s: float, T: Matrix) -> None:
        """Add a guess. Any thread."""
        self._buffer.push(stamp_s, T)

    def clear(self) -> None:
        """Forget all guesses. Any thread."""
        self._buffer.clear()

    def is_there(self, stamp_s: float) -> bool:
        """Tell whether a scan need not wait for its guess. Any thread."""
        return self._newest_holds or self._buffer.reaches(stamp_s)

    def note_scan(self, stamp_s: float) -> None:
        """Note the stamp of each scan as it arrives: their period bounds the age of guesses."""
        if self._last_scan_s is not None and stamp_s > self._last_scan_s:
            self._periods_s.append(stamp_s - self._last_scan_s)
            self._period_s = median(self._periods_s)
        self._last_scan_s = stamp_s

    def motion_until(self, stamp_s: float, T: Matrix) -> tuple[Matrix, float] | None:
        """Return the motion (4, 4) up to a pose at a time, and how long it took; None if unknown.

        Where guesses follow results, a result that corrects its guess makes the next guess jump,
        and that jump would count as motion: over several periods it counts little.
        """
        before = self._buffer.newest_before(stamp_s - MOTION_S)
        before = before or self._buffer.oldest()
        if before is None or not MIN_MOTION_S <= stamp_s - before.stamp_s <= KEPT_S:
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
