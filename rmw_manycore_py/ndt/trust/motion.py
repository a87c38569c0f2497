# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""Checks whether a vehicle can have moved from the believed poses to another one.

The expected pose has two sources: the motion up to the last believed pose, valid for half a second,
and the motion of the guesses since then (odometry in most stacks), valid for longer unless the
guesses jump.
"""

from __future__ import annotations

from collections import deque
from dataclasses import dataclass, replace

import numpy as np

from rmw_manycore_py.ndt.geometry import poses
from rmw_manycore_py.ndt.geometry.arrays import Pose
from rmw_manycore_py.ndt.trust.along import BASIN_M, Along

NEAR_M, NEAR_RAD = 1.0, np.radians(15.0)  # within this distance, only the score decides
ACCELERATION_M_S2 = 10.0  # an emergency braking of any vehicle
TURN_ACCELERATION_RAD_S2 = 8.0  # a LiDAR carried by hand
STEADY_S = 0.55  # maximum extrapolation of the motion: scans at 2 Hz
GUESS_DRIFT = 0.1  # relative error of the guesses' motion
# Maximum shift of guesses between two scans; a larger one is a jump.
SHIFT_M = 2.5
SHIFT_ACCELERATION_M_S2 = 3.0
MAX_DRAWN_M = 4.5  # beyond, a repetitive street would be ambiguous
# Guesses may turn as fast as a hand turns a LiDAR, but not around: those have jumped.
TURN_RAD_S, MAX_TURN_RAD = 6.0, np.radians(120.0)
MAX_SPEED_M_S = 60.0
MOVING_M = 0.2  # between two poses: their direction is the vehicle's
STEADY_SHARE = 0.3  # of the distance at constant speed: guesses that differ by more are in doubt


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
    :param gap: what the vehicle may have driven, if its motion is too old.
    :param is_first: only one pose was believed: the vehicle may stand, whatever the guesses do.
    :param is_steady: the guesses moved about as far as the last motion leads.
    """

    last: Pose
    by_motion: Pose | None
    by_guess: Pose | None
    age_s: float
    guess_motion_m: float = 0.0
    guess_motion_rad: float = 0.0
    gap: Along | None = None
    is_steady: bool = True
    guess: Pose | None = None
    is_first: bool = False

    @property
    def poses(self) -> list[Pose]:
        """Return the expected poses, most probable first."""
        return [T for T in (self.by_guess, self.by_motion, self.last) if T is not None]

    @property
    def middle(self) -> Pose:
        """Return the middle of the uncertainty: half of the way that may have been driven."""
        if self.gap is None:
            return self.poses[0]
        return self.gap.moved(self.last, self.gap.deviation_m)

    def why_implausible(self, T: Pose, along: Along | None = None) -> str:
        """Return how far a pose is from the expected ones; "" if it is near enough.

        :param along: uncertainty of the expected poses.
        """

        def near(expected: Pose) -> Pose:
            return expected if along is None else along.nearest(expected, T)

        speed_m_s = (poses.distance_m(near(self.last), T) - NEAR_M) / max(self.age_s, 1e-3)
        if speed_m_s > MAX_SPEED_M_S:
            return f"it is {poses.distance_m(self.last, T):.1f} m from the last one"
        found = []
        if self.by_motion is not None:
            reach_m = NEAR_M + 0.5 * ACCELERATION_M_S2 * self.age_s**2
            reach_rad = NEAR_RAD + 0.5 * TURN_ACCELERATION_RAD_S2 * self.age_s**2
            found.append(_beyond(near(self.by_motion), T, reach_m, reach_rad))
        if self.by_guess is not None:
            reach_m = NEAR_M + GUESS_DRIFT * self.guess_motion_m
            reach_rad = NEAR_RAD + GUESS_DRIFT * self.guess_motion_rad
            found.append(_beyond(near(self.by_guess), T, reach_m, reach_rad))
        if self.gap is not None and along is not None:
            reach_m = NEAR_M + GUESS_DRIFT * self.gap.reach_m
            found.append(_beyond(near(self.middle), T, reach_m, _turn_rad(self.age_s)))
        if self.is_first:
            drawn_m = 0.5 * SHIFT_ACCELERATION_M_S2 * self.age_s**2
            reach_m = NEAR_M + SHIFT_M + min(drawn_m, MAX_DRAWN_M)
            found.append(_beyond(self.last, T, reach_m, _turn_rad(self.age_s)))
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

    def correct(self, T: Pose, expected: Expectation) -> None:
        """Move the poses that led to the expected one: the vehicle is at `T`, moving as before."""
        offset_m = T[:3, 3] - expected.poses[0][:3, 3]
        for index, one in enumerate(self._believed):
            moved = one.T.copy()
            moved[:3, 3] += offset_m
            self._believed[index] = replace(one, T=moved)

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
            is_turned = poses.angle_rad(last.T, moved) > _turn_rad(age_s)
            if poses.distance_m(from_here, moved) <= reach_m and not is_turned:
                by_guess = moved
        guess_motion_m = float(np.linalg.norm(motion[:3, 3]))
        steady_m = _speed_m_s(self._believed) * age_s
        is_first = len(self._believed) < 2
        apart_m = abs(guess_motion_m - steady_m)
        return Expectation(
            last.T,
            by_motion,
            by_guess,
            age_s,
            guess_motion_m,
            float(np.linalg.norm(poses.rotation_vector(motion[:3, :3]))),
            gap=self._gap(age_s) if by_motion is None and not is_first else None,
            guess=guess,
            is_first=is_first,
            is_steady=by_guess is not None and apart_m <= _steady_within_m(steady_m),
        )

    def _gap(self, age_s: float) -> Along:
        """Return the distance that may have been driven ahead, as twice the deviation."""
        driven_m = _speed_m_s(self._believed) * age_s + 0.5 * SHIFT_ACCELERATION_M_S2 * age_s**2
        last = self._believed[-1].T
        ahead = last[:2, 0]
        moved = last[:2, 3] - self._believed[0].T[:2, 3]
        if np.linalg.norm(moved) > MOVING_M:
            ahead = moved
        return Along(ahead / max(float(np.linalg.norm(ahead)), 1e-9), 0.5 * driven_m)

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


def _steady_within_m(driven_m: float) -> float:
    """Return by how much guesses may differ from a constant speed: alignments come home from it."""
    return min(max(NEAR_M, STEADY_SHARE * driven_m), BASIN_M)


def _turn_rad(age_s: float) -> float:
    """Return the largest turn within a time."""
    return float(min(NEAR_RAD + TURN_RAD_S * age_s, MAX_TURN_RAD))


def _beyond(expected: Pose, T: Pose, reach_m: float, reach_rad: float) -> str:
    distance_m = poses.distance_m(expected, T)
    angle_rad = poses.angle_rad(expected, T)
    if distance_m <= reach_m and angle_rad <= reach_rad:
        return ""
    return (
        f"it is {distance_m:.1f} m and {np.degrees(angle_rad):.0f} degrees from where the motion "
        f"leads, more than {reach_m:.1f} m or {np.degrees(min(reach_rad, np.pi)):.0f} degrees"
    )
