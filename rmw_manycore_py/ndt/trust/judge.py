# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""Judges the result of an alignment: score, drop of the score, motion."""

from __future__ import annotations

from collections import deque
from dataclasses import dataclass
from statistics import median

import numpy as np

from rmw_manycore_py.ndt.geometry import poses
from rmw_manycore_py.ndt.geometry.arrays import Matrix6, Pose
from rmw_manycore_py.ndt.matching.alignment import Alignment
from rmw_manycore_py.ndt.trust.along import BASIN_M, Along
from rmw_manycore_py.ndt.trust.motion import STEADY_SHARE, Believed, Expectation, MotionModel
from rmw_manycore_py.ndt.trust.score_level import ScoreLevel
from rmw_manycore_py.ndt.trust.weak import Weak, weak_directions

MIN_SHARE_IN_MAP = 0.3  # of the points: below, the vehicle is outside the map or elsewhere
DROP_SHARE = 0.88  # of the median of recent scores: lower is a sudden drop
DROP_SCORES = 5
SURE_AFTER = 3  # consecutive poses that each agree with the previous one
UNSURE_M, UNSURE_RAD = 1.0, 0.2  # standard deviations of an unconfirmed pose
WEAK_M = 2.0  # standard deviation along the weak axis, where it begins
WEAK_RAD = 0.05  # of the yaw, where both are weak
WEAK_DRIFT = 0.05  # growth of that per metre driven
GAP_DRIFT = 0.5 * STEADY_SHARE  # likewise in a gap, where nothing checks the odometry
RESOLVED_AFTER = 2  # times that a place stood out along the uncertain direction
COVERED_DEVIATIONS = 3.0
COVERED_M, COVERED_RAD = 0.5, np.radians(3.0)  # error covered without a weak axis


@dataclass(frozen=True)
class Verdict:
    """Judgement of a pose.

    :param why: reason to reject the pose; "" for a believed one.
    :param is_sure: believed, and confirmed by the previous poses.
    :param level: the required score.
    :param expected: expected pose of the vehicle, if known.
    :param along: direction in which the position is uncertain.
    :param weak: what the scan itself does not constrain.
    :param is_score_low: the score refuses the pose, whatever else does.
    :param is_plausible: the motion leads there, as far as it is known.
    """

    why: str
    is_sure: bool
    level: float
    expected: Expectation | None
    along: Along | None = None
    weak: Weak | None = None
    is_score_low: bool = False
    is_plausible: bool = True

    @property
    def is_believed(self) -> bool:
        """Return whether the pose may be used."""
        return not self.why

    def covariance(self, of_sure: Matrix6) -> Matrix6:
        """Return the covariance (6, 6): that of a sure pose, enlarged if this one is not sure."""
        wide: Matrix6 = of_sure.copy()
        if not self.is_sure and (self.along is None or not self.along.is_open):
            least = np.square([*(UNSURE_M,) * 3, *(UNSURE_RAD,) * 3])
            np.fill_diagonal(wide, np.maximum(np.diag(of_sure), least))
        if self.along is not None:
            wide[:2, :2] += self.along.covariance_m2
        if self.weak is not None and self.weak.is_all:
            wide[5, 5] = max(wide[5, 5], WEAK_RAD**2)
        return wide

    def corrected(self, T: Pose) -> Pose:
        """Return a pose that follows the guesses along the direction that its scan leaves open.

        There an alignment ends at the nearest of many maxima, one for each voxel.
        """
        if self.along is None or self.weak is None or self.expected is None:
            return T
        expected, guess = self.expected, self.expected.guess
        base = expected.poses[0] if expected.is_steady else expected.middle
        if guess is not None and abs(self.along.offset_m(base, guess)) <= self.along.reach_m:
            base = guess
        if not self.weak.is_all:
            return self.along.moved(T, self.along.offset_m(T, base))
        follows: Pose = T.copy()
        follows[:2, 3] = base[:2, 3]
        return follows

    @property
    def uncertain(self) -> Along | None:
        """Return the direction along which one of several places may stand out, if any."""
        along = self.along
        if not self.is_believed and self.expected is not None and along is None:
            along = self.expected.gap
        return along if along is not None and along.is_open else None

    def covers(self, T: Pose, truth: Pose) -> bool:
        """Return whether the uncertain direction explains an error; for tests of the judge."""
        error = T[:3, 3] - truth[:3, 3]
        if self.along is not None:
            error[:2] = self.along.beyond_m(error[:2], COVERED_DEVIATIONS)
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
        self._along: Along | None = None

    def forget(self) -> None:
        """Reset: the vehicle may be anywhere."""
        self.level.forget()
        self.motion.forget()
        self._recent.clear()
        self._confirmed = 0
        self._along = None

    def judge(
        self,
        stamp_s: float,
        alignment: Alignment,
        guess: Pose | None,
        *,
        stood_out: int = 0,
    ) -> Verdict:
        """Judge the alignment of a scan, from any start. Does not change the state.

        :param guess: the guess T_map_base of the scan.
        :param stood_out: how often the place stood out along the uncertain direction.
        """
        expected = self.motion.at(stamp_s, guess)
        along = self._uncertain(expected, stood_out)
        unusable = why_unusable(alignment)
        low = "" if unusable else self._why_low(alignment, is_first=expected is None)
        implausible = "" if unusable else _why_implausible(alignment, expected, along)
        why = unusable or low or implausible
        weak = weak_directions(alignment)
        if stood_out >= RESOLVED_AFTER:
            along = None
        elif weak is not None:
            along = _weakened(weak, along, self._drift_m(alignment, expected))
        elif along is not None and not along.is_open:
            along = None
        is_sure = not why and expected is not None and self._confirmed >= SURE_AFTER
        is_sure = is_sure and (along is None or not along.is_open)
        is_low, is_plausible, level = bool(low), not implausible, self.level.level
        return Verdict(why, is_sure, level, expected, along, weak, is_low, is_plausible)

    def _uncertain(self, expected: Expectation | None, stood_out: int) -> Along | None:
        """Return the direction in which the expected pose is uncertain."""
        gap = None if expected is None else expected.gap
        if gap is None or (expected is not None and expected.is_steady and not stood_out):
            return self._along
        return gap if self._along is None else self._along.joined(gap)

    def _drift_m(self, alignment: Alignment, expected: Expectation | None) -> float:
        """Return by how much the deviation in a weak direction grows: until features return."""
        if expected is None:
            return 0.0
        moved_m = poses.distance_m(expected.last, alignment.T_map_sensor)
        driven_m = max(moved_m, expected.guess_motion_m)
        return (GAP_DRIFT if expected.gap is not None else WEAK_DRIFT) * driven_m

    def may_look_again(self, verdict: Verdict) -> bool:
        """Return whether a refused result may be replaced by one from farther off.

        Motion confirms or refutes that one. For a first pose only a search does, by whether the
        pose stands out.
        """
        return verdict.expected is not None or not self._searches

    def believe(
        self,
        stamp_s: float,
        alignment: Alignment,
        guess: Pose | None,
        *,
        stood_out: int = 0,
    ) -> None:
        """Continue from a pose that was judged good."""
        verdict = self.judge(stamp_s, alignment, guess, stood_out=stood_out)
        self._along = verdict.along
        if stood_out and verdict.expected is not None and verdict.expected.gap is None:
            self.motion.correct(alignment.T_map_sensor, verdict.expected)
        self._confirmed += 1
        self.motion.believe(stamp_s, alignment.T_map_sensor, guess)
        score = max(alignment.nearest_voxel_likelihood, alignment.explained_score)
        self._recent.append(score)
        if self._confirmed > SURE_AFTER:
            self.level.learn(score)

    def begin_at(self, at: Believed) -> None:
        """Continue from a pose found by a search or left by a previous process.

        Discards earlier scores, which belong to another place.
        """
        self.forget()
        self.motion.believe(at.stamp_s, at.T, at.guess)

    def _why_low(self, alignment: Alignment, *, is_first: bool) -> str:
        """Return how a score is too low; "" also if foreign points, or unmapped ones, explain it.

        :param is_first: no motion confirms the pose.
        """
        level = self.level
        if alignment.explained_score > (level.of_explained if is_first else level.of_confirmed):
            return ""
        score = alignment.nearest_voxel_likelihood
        if not score > level.level:
            return f"the score {score:.3f} is not above the level {level.level:.3f}"
        if len(self._recent) == DROP_SCORES and score < DROP_SHARE * median(self._recent):
            return f"the score fell from {median(self._recent):.3f} to {score:.3f}"
        if is_first and self._searches and not alignment.fit > level.of_first:
            return f"the first pose's fit {alignment.fit:.3f} is below {level.of_first:.3f}"
        return ""


def why_unusable(alignment: Alignment) -> str:
    """Return why a pose is refused whatever its score; "" if it is not."""
    if not alignment.converged:
        return f"no convergence: {alignment.why}"
    if alignment.share_in_map < MIN_SHARE_IN_MAP:
        return f"only {100 * alignment.share_in_map:.0f} % of the points lie in the map"
    return ""


def _why_implausible(
    alignment: Alignment, expected: Expectation | None, along: Along | None
) -> str:
    why = "" if expected is None else expected.why_implausible(alignment.T_map_sensor, along)
    return f"the pose is implausible: {why}" if why else ""


def _weakened(weak: Weak, along: Along | None, drift_m: float) -> Along:
    """Return the uncertainty after a weak scan: it grows in what that leaves open.

    What a scan constrains is resolved if alignments come home from the uncertainty before.
    """
    if along is None:
        return Along(weak.axis, WEAK_M + drift_m, WEAK_M + drift_m if weak.is_all else 0.0)
    is_along = abs(float(weak.axis @ along.axis)) >= np.cos(np.pi / 4)

    def after_m(before_m: float, *, is_open: bool) -> float:
        if is_open:
            return max(WEAK_M, before_m) + drift_m
        return before_m if before_m > BASIN_M else 0.0

    deviation_m = after_m(along.deviation_m, is_open=weak.is_all or is_along)
    across_m = after_m(along.across_m, is_open=weak.is_all or not is_along)
    axis = weak.axis if is_along and not weak.is_all else along.axis
    return Along(axis, deviation_m, across_m)
