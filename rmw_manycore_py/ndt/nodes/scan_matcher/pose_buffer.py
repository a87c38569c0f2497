# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""Buffer of recent poses with interpolation in time."""

from __future__ import annotations

import threading
from collections import deque
from collections.abc import Callable
from dataclasses import dataclass

from rmw_manycore_py.ndt.geometry import poses
from rmw_manycore_py.ndt.geometry.arrays import Matrix

HOLD_S = 0.02  # a pose up to this age is used without known motion: 0.3 m at 15 m/s


@dataclass(frozen=True)
class StampedPose:
    """A pose and its time in seconds."""

    stamp_s: float
    T: Matrix


@dataclass(frozen=True)
class Interpolated:
    """The pose at a time, and the poses before and after it that it was computed from.

    :param age_s: age of the newest of them at that time; 0 if interpolated.
    """

    T: Matrix
    old: StampedPose
    new: StampedPose
    age_s: float = 0.0


class NoPoseError(LookupError):
    """The buffer does not determine the pose at a time; the message has the reason."""


class PoseBuffer:
    """Keeps the newest poses. Thread-safe.

    :param timeout_s: maximum time between a pose and the requested time.
    :param distance_tolerance_m: maximum distance between interpolated poses.
    """

    def __init__(self, timeout_s: float, distance_tolerance_m: float) -> None:
        self._timeout_s = timeout_s
        self._distance_tolerance_m = distance_tolerance_m
        self._poses: deque[StampedPose] = deque(maxlen=1000)
        self._lock = threading.Lock()

    def push(self, stamp_s: float, T: Matrix) -> None:
        """Add a pose; if time jumps back, as in a repeated recording, drop all others."""
        with self._lock:
            if self._poses and stamp_s < self._poses[-1].stamp_s:
                self._poses.clear()
            self._poses.append(StampedPose(stamp_s, T))

    def clear(self) -> None:
        """Drop all poses."""
        with self._lock:
            self._poses.clear()

    def forget_before(self, stamp_s: float, kept_s: float = 0.0) -> None:
        """Drop poses that later times cannot need, except those of the last `kept_s`."""
        with self._lock:
            while len(self._poses) > 2 and self._poses[1].stamp_s <= stamp_s - kept_s:
                self._poses.popleft()

    def reaches(self, stamp_s: float) -> bool:
        """Return whether there is a pose at or after a time."""
        with self._lock:
            return bool(self._poses) and self._poses[-1].stamp_s >= stamp_s

    def drive_until(
        self, stamp_s: float, since_s: float, jump_m: float, max_speed_m_s: float
    ) -> list[StampedPose]:
        """Return the poses up to a time, oldest first, after the last jump among them.

        A jump is a step of more than `jump_m` beyond what `max_speed_m_s` allows.
        """
        with self._lock:
            found = [pose for pose in self._poses if since_s <= pose.stamp_s <= stamp_s]
        for index in range(len(found) - 1, 0, -1):
            old, new = found[index - 1], found[index]
            reach_m = jump_m + max_speed_m_s * (new.stamp_s - old.stamp_s)
            if poses.distance_m(old.T, new.T) > reach_m:
                return found[index:]
        return found

    def newest_at(self, stamp_s: float) -> Interpolated | None:
        """Return the pose at a time as Autoware's node does: the newest one holds after its time.

        None without two poses near the time.
        """
        with self._lock:
            if len(self._poses) < 2 or stamp_s < self._poses[0].stamp_s:
                return None
            found = self._between(stamp_s, poses.interpolate_on_chord)
        return None if isinstance(found, str) else found

    def at(self, stamp_s: float, reach_s: float) -> Interpolated:
        """Return the pose at a time: interpolated, or extrapolated from the newest one.

        :param reach_s: maximum extrapolation time.
        :raises NoPoseError: if the poses do not determine it.
        """
        with self._lock:
            if not self._poses:
                raise NoPoseError("no pose has arrived")
            first, newest = self._poses[0], self._poses[-1]
            if stamp_s < first.stamp_s:
                raise NoPoseError(f"the oldest pose is {first.stamp_s - stamp_s:.3f} s newer")
            if stamp_s > newest.stamp_s:
                return self._moved_on(stamp_s, min(reach_s, self._timeout_s))
            found = self._between(stamp_s, poses.interpolate)
        if isinstance(found, str):
            raise NoPoseError(found)
        return found

    def _between(
        self, stamp_s: float, interpolate: Callable[[Matrix, Matrix, float], Matrix]
    ) -> Interpolated | str:
        """Return the pose interpolated between its neighbours, or why that is impossible."""
        old = next(p for p in reversed(self._poses) if p.stamp_s <= stamp_s)
        new = next((p for p in self._poses if p.stamp_s > stamp_s), old)
        if old.stamp_s == stamp_s:
            return Interpolated(old.T, old, old)
        gap_s = max(stamp_s - old.stamp_s, new.stamp_s - stamp_s)
        if gap_s > self._timeout_s:
            return f"poses around it are {gap_s:.3f} s away, more than {self._timeout_s:g} s"
        jump_m = poses.distance_m(old.T, new.T)
        if jump_m > self._distance_tolerance_m:
            return f"the poses around it are {jump_m:.1f} m apart"
        if new is old:
            return Interpolated(old.T, old, old, stamp_s - old.stamp_s)
        share = (stamp_s - old.stamp_s) / (new.stamp_s - old.stamp_s)
        return Interpolated(interpolate(old.T, new.T, share), old, new)

    def _moved_on(self, stamp_s: float, reach_s: float) -> Interpolated:
        """Extrapolate the newest motion, estimated over at least as long a time."""
        newest = self._poses[-1]
        age_s = stamp_s - newest.stamp_s
        if age_s > reach_s:
            raise NoPoseError(f"the newest pose is {age_s:.3f} s older, more than {reach_s:.3f} s")
        start_s = newest.stamp_s - age_s
        before = next((p for p in reversed(self._poses) if p.stamp_s <= start_s), None)
        if before is None or newest.stamp_s - before.stamp_s > self._timeout_s:
            if age_s > HOLD_S:
                raise NoPoseError(
                    f"the newest pose is {age_s:.3f} s older, and no pose before it determines the "
                    "motion"
                )
            return Interpolated(newest.T, newest, newest, age_s)
        moved_m = poses.distance_m(before.T, newest.T)
        if moved_m > self._distance_tolerance_m:
            raise NoPoseError(f"the newest pose is {moved_m:.1f} m from the one before it")
        share = age_s / (newest.stamp_s - before.stamp_s)
        motion = poses.inverse(before.T) @ newest.T
        T = newest.T @ poses.part_of_motion(motion, share)
        return Interpolated(T, before, newest, age_s)
