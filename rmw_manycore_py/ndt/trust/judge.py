# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""Judges the result of an alignment: score, drop of the score, motion."""

from __future__ import annotations

from collections import deque
from dataclasses import dataclass
from statistics import median

import numpy as np

from rmw_manycore_py.ndt.geometry import poses
from rmw_manycore_py.ndt.geometry.arrays import Matrix, Matrix6, Pose
from rmw_manycore_py.ndt.matching.alignment import Alignment
from rmw_manycore_py.ndt.trust.motion import Believed, Expectation, MotionModel
from rmw_manycore_py.ndt.trust.score_level import ScoreLevel

MIN_SHARE_IN_MAP = 0.3  # of the points: below, the vehicle is outside the map or elsewhere
DROP_SHARE = 0.88  # of the median of recent scores: lower is a sudden drop
DROP_SCORES = 5
SURE_AFTER = 3  # consecutive poses that each agree with the previous one
UNSURE_M, UNSURE_RAD = 1.0, 0.2  # standard deviations of an unconfirmed pose
# Minimum spread of a scan that does not constrain the position along a street. It is 0.14 to 0.48
# on streets, also repetitive ones, and recorded scans; 0.62 and more in a bare tunnel.
WEAK_SPREAD_M = 0.55
WEAK_M = 2.0  # standard deviation along the weak axis
COVERED_DEVIATIONS = 3.0
COVERED_M, COVERED_RAD = 0.5, np.radians(3.0)  # error covered without a weak axis


@dataclass(frozen=True)
class Verdict:
    """Judgement of a pose.

    :param why: reason to reject the pose; "" for a believed one.
    :param is_sure: believed, and confirmed by the previous poses.
    :param level: the required score.
    :param expected: expected pose of the vehicle, if known.
    :param weak_axis: direction (2,) in the map in which the scan does not constrain the position.
    """

    why: str
    is_sure: bool
    level: float
    expected: Expectation | None
    weak_axis: Matrix | None = None

    @property
    def is_believed(self) -> bool:
        """Return whether the pose may be used."""
        return not self.why

    def covariance(self, of_sure: Matrix6) -> Matrix6:
        """Return the covariance (6, 6): that of a sure pose, enlarged if this one is not sure."""
        wide: Matrix6 = of_sure.copy()
        if not self.is_sure:
            least = np.square([*(UNSURE_M,) * 3, *(UNSURE_RAD,) * 3])
            np.fill_diagonal(wide, np.maximum(np.diag(of_sure), least))
        if self.weak_axis is not None:
            wide[:2, :2] += WEAK_M**2 * np.outer(self.weak_axis, self.weak_axis)
        return wide

    def covers(self, T: Pose, truth: Pose) -> bool:
        """Return whether an error is explained by the weak axis; for tests of the judge."""
        error = T[:3, 3] - truth[:3, 3]
        if self.weak_axis is not None:
            along = float(error[:2] @ self.weak_axis)
            if abs(along) > COVERED_DEVIATIONS * WEAK_M:
                return False
            error[:2] -= along * self.weak_axis
        is_near = bool(np.linalg.norm(error) <= COVERED_M)
        return is_near and poses.angle_rad(T, truth) <= COVERED_RAD


class PoseJudge:
    """Judges the poses of one drive, scan by scan; learns from those it believes.

    :param searches: a search finds the first pose if the result of the guess is not good enough.
    """

    def __init__(self, level: ScoreLevel | None = None, *, searches: bool = True) -> None:
        self._searches = searches
        self.level = level or ScoreLevel()
        self.motion = MotionModel()
        self._recent: deque[float] = deque(maxlen=DROP_SCORES)
        self._confirmed = 0

    def forget(self) -> None:
        """Reset: the vehicle may be anywhere."""
        self.level.forget()
        self.motion.forget()
        self._recent.clear()
        self._confirmed = 0

    def judge(self, stamp_s: float, alignment: Alignment, guess: Pose | None) -> Verdict:
        """Judge the alignment of a scan, from any start. Does not change the state.

        :param guess: the guess T_map_base of the scan.
        """
        expected = self.motion.at(stamp_s, guess)
        why = self._why_not(alignment, expected)
        is_sure = not why and expected is not None and self._confirmed >= SURE_AFTER
        return Verdict(why, is_sure, self.level.level, expected, weak_axis(alignment))

    def may_look_again(self, verdict: Verdict) -> bool:
        """Return whether a refused result may be replaced by one from farther off.

        Motion confirms or refutes that one. For a first pose only a search does, by whether the
        pose stands out.
        """
        return verdict.expected is not None or not self._searches

    def believe(self, stamp_s: float, alignment: Alignment, guess: Pose | None) -> None:
        """Continue from a pose that was judged good."""
        self._confirmed += 1
        self.motion.believe(stamp_s, alignment.T_map_sensor, guess)
        self._recent.append(alignment.nearest_voxel_likelihood)
        if self._confirmed > SURE_AFTER:
            self.level.learn(alignment.nearest_voxel_likelihood)

    def begin_at(self, at: Believed) -> None:
        """Continue from a pose found by a search or left by a previous process.

        Discards earlier scores, which belong to another place.
        """
        self.forget()
        self.motion.believe(at.stamp_s, at.T, at.guess)

    def _why_not(self, alignment: Alignment, expected: Expectation | None) -> str:
        score = alignment.nearest_voxel_likelihood
        if alignment.is_degenerate:
            return f"no convergence: {alignment.why}"
        if alignment.share_in_map < MIN_SHARE_IN_MAP:
            return f"only {100 * alignment.share_in_map:.0f} % of the points lie in the map"
        if not score > self.level.level:
            return f"the score {score:.3f} is not above the level {self.level.level:.3f}"
        if len(self._recent) == DROP_SCORES and score < DROP_SHARE * median(self._recent):
            return f"the score fell from {median(self._recent):.3f} to {score:.3f}"
        if expected is None:
            return self._why_not_first(alignment)
        implausible = expected.why_implausible(alignment.T_map_sensor)
        return f"the pose is implausible: {implausible}" if implausible else ""

    def _why_not_first(self, alignment: Alignment) -> str:
        if not self._searches or alignment.fit > self.level.of_first:
            return ""
        return f"the first pose's fit {alignment.fit:.3f} is below {self.level.of_first:.3f}"


def weak_axis(alignment: Alignment) -> Matrix | None:
    """Return the direction (2,) in which the scan does not constrain x and y; None without one."""
    values, vectors = np.linalg.eigh(alignment.xy_spread_m2)
    axis: Matrix = vectors[:, 1]
    return axis if values[1] > WEAK_SPREAD_M**2 else None
