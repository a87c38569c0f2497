# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""Checks whether a vehicle can have moved from the believed poses to another one.

The expected pose has two sources: the motion up to the last believed pose, valid for half a second,
and the motion of the guesses since then (odometry in most stacks), valid for longer unless the
guesses jump.
"""

from __future__ import annotations

from collections import deque
from dataclasses import dataclass

import numpy as np

from rmw_manycore_py.ndt.geometry import poses
from rmw_manycore_py.ndt.geometry.arrays import Pose

NEAR_M, NEAR_RAD = 1.0, np.radians(15.0)  # within this distance, only the score decides
ACCELERATION_M_S2 = 10.0  # an emergency braking of any vehicle
TURN_ACCELERATION_RAD_S2 = 8.0  # a LiDAR carried by hand
STEADY_S = 0.55  # maximum extrapolation of the motion: scans at 2 Hz
GUESS_DRIFT = 0.1  # relative error of the guesses' motion
# Maximum shift of guesses between two scans; a larger one is a jump.
SHIFT_M = 2.5
SHIFT_ACCELERATION_M_S2 = 3.0
MAX_DRAWN_M = 4.5  # beyond, a repetitive street would be ambiguous
MAX_SPEED_M_S = 60.0


@dataclass(frozen=True)
class Believed:
    """A believed pose T_map_base, and the guess of the same scan."""

    stamp_s: float
    T: Pose
    guess: Pose | None


@dataclass(frozen=True)
class Expectation:
    """Expected pose of the vehicle.

    :param by_motion: extrapolated from the last believed poses; None if they determine no motion.
    :param by_guess: moved like the guesses; None if they have jumped or are missing.
    :param age_s: time since the last believed pose.
    """

    last: Pose
    by_motion: Pose | None
    by_guess: Pose | None
    age_s: float
    guess_motion_m: float = 0.0
    guess_motion_rad: float = 0.0

    @property
    def poses(self) -> list[Pose]:
        """Return the expected poses, most probable first."""
        return [T for T in (self.by_guess, self.by_motion, self.last) if T is not None]

    def why_implausible(self, T: Pose) -> str:
        """Return how far a pose is from the expected ones; "" if it is near enough."""
        speed_m_s = (poses.distance_m(self.last, T) - NEAR_M) / max(self.age_s, 1e-3)
        if speed_m_s > MAX_SPEED_M_S:
            return f"it is {poses.distance_m(self.last, T):.1f} m from the last one"
        found = []
        if self.by_motion is not None:
            reach_m = NEAR_M + 0.5 * ACCELERATION_M_S2 * self.age_s**2
            reach_rad = NEAR_RAD + 0.5 * TURN_ACCELERATION_RAD_S2 * self.age_s**2
            found.append(_beyond(self.by_motion, T, reach_m, reach_rad))
        if self.by_guess is not None:
            reach_m = NEAR_M + GUESS_DRIFT * self.guess_motion_m
            reach_rad = NEAR_RAD + GUESS_DRIFT * self.guess_motion_rad
            found.append(_beyond(self.by_guess, T, reach_m, reach_rad))
        if self.by_motion is None:
            # The vehicle may have stood still, whatever the guesses did.
            drawn_m = 0.5 * SHIFT_ACCELERATION_M_S2 * self.age_s**2
            reach_m = NEAR_M + SHIFT_M + min(drawn_m, MAX_DRAWN_M)
            found.append(_beyond(self.last, T, reach_m, np.pi))
        return "" if "" in found else found[-1]


class MotionModel:
    """Keeps the last believed poses."""

    def __init__(self) -> None:
        self._believed: deque[Believed] = deque(maxlen=2)

    @property
    def last(self) -> Believed | None:
        """Return the newest believed pose."""
        return self._believed[-1] if self._believed else None

    def believe(self, stamp_s: float, T: Pose, guess: Pose | None) -> None:
        """Add a pose; if time jumps back, as in a repeated recording, start over."""
        if self.last is not None and stamp_s <= self.last.stamp_s:
            self._believed.clear()
        self._believed.append(Believed(stamp_s, T, guess))

    def forget(self) -> None:
        """Reset."""
        self._believed.clear()

    def at(self, stamp_s: float, guess: Pose | None) -> Expectation | None:
        """Return the expected pose at a time; None if unknown.

        :param guess: the guess T_map_base for that time.
        """
        last = self.last
        if last is None or stamp_s <= last.stamp_s:
            return None
        age_s = stamp_s - last.stamp_s
        by_motion = self._continued(age_s)
        by_guess, motion = None, np.eye(4)
        if guess is not None and last.guess is not None:
            motion = poses.inverse(last.guess) @ guess
            moved = last.T @ motion
            from_here = last.T if by_motion is None else by_motion
            reach_m = SHIFT_M + 0.5 * SHIFT_ACCELERATION_M_S2 * age_s**2
            if by_motion is None:
                reach_m += _speed_m_s(self._believed) * age_s
            if poses.distance_m(from_here, moved) <= reach_m:
                by_guess = moved
        return Expectation(
            last.T,
            by_motion,
            by_guess,
            age_s,
            float(np.linalg.norm(motion[:3, 3])),
            float(np.linalg.norm(poses.rotation_vector(motion[:3, :3]))),
        )

    def _continued(self, age_s: float) -> Pose | None:
        if len(self._believed) < 2 or age_s > STEADY_S:
            return None
        before, last = self._believed
        span_s = last.stamp_s - before.stamp_s
        if span_s > STEADY_S:
            return None
        motion = poses.inverse(before.T) @ last.T
        continued: Pose = last.T @ poses.part_of_motion(motion, age_s / span_s)
        return continued


def _speed_m_s(believed: deque[Believed]) -> float:
    """Return the speed between the last two poses; without two, that of a car on a main road."""
    if len(believed) < 2:
        return 25.0
    before, last = believed
    return poses.distance_m(before.T, last.T) / (last.stamp_s - before.stamp_s)


def _beyond(expected: Pose, T: Pose, reach_m: float, reach_rad: float) -> str:
    distance_m = poses.distance_m(expected, T)
    angle_rad = poses.angle_rad(expected, T)
    if distance_m <= reach_m and angle_rad <= reach_rad:
        return ""
    return (
        f"it is {distance_m:.1f} m and {np.degrees(angle_rad):.0f} degrees from where the motion "
        f"leads, more than {reach_m:.1f} m or {np.degrees(min(reach_rad, np.pi)):.0f} degrees"
    )
