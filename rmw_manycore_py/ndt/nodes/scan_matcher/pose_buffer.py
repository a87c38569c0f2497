# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""Poses of the last seconds, to be asked for the pose at a time."""

from __future__ import annotations

from collections import deque
from dataclasses import dataclass

from rmw_manycore_py.ndt.geometry import poses
from rmw_manycore_py.ndt.geometry.arrays import Matrix


@dataclass(frozen=True)
class StampedPose:
    """A pose and its time in seconds."""

    stamp_s: float
    T: Matrix


@dataclass(frozen=True)
class Interpolated:
    """The pose at a time, and those before and after it that it comes from."""

    T: Matrix
    old: StampedPose
    new: StampedPose


class PoseBuffer:
    """Needs two poses near a time; after the newest one, the newest holds."""

    def __init__(self, timeout_s: float, distance_tolerance_m: float) -> None:
        self._timeout_s = timeout_s
        self._distance_tolerance_m = distance_tolerance_m
        self._poses: deque[StampedPose] = deque(maxlen=1000)

    def push(self, stamp_s: float, T: Matrix) -> None:
        """Add a pose; when time jumps back, as in a recording played again, forget all others."""
        if self._poses and stamp_s < self._poses[-1].stamp_s:
            self._poses.clear()
        self._poses.append(StampedPose(stamp_s, T))

    def clear(self) -> None:
        """Forget all poses."""
        self._poses.clear()

    def forget_before(self, stamp_s: float) -> None:
        """Forget poses that no later time can need."""
        while len(self._poses) > 2 and self._poses[1].stamp_s <= stamp_s:
            self._poses.popleft()

    def at(self, stamp_s: float) -> Interpolated | None:
        """Return the pose at a time, or None where the poses there are do not tell."""
        if len(self._poses) < 2 or stamp_s < self._poses[0].stamp_s:
            return None
        old = max((p for p in self._poses if p.stamp_s <= stamp_s), key=lambda p: p.stamp_s)
        new = next((p for p in self._poses if p.stamp_s > stamp_s), old)
        if max(stamp_s - old.stamp_s, new.stamp_s - stamp_s) > self._timeout_s:
            return None
        if poses.distance_m(old.T, new.T) > self._distance_tolerance_m:
            return None
        span_s = new.stamp_s - old.stamp_s
        share = (stamp_s - old.stamp_s) / span_s if span_s > 0.0 else 0.0
        return Interpolated(poses.interpolate(old.T, new.T, share), old, new)
