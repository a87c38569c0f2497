# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""Aligns a scan from several places along an uncertain direction; believes what stands out.

A place that leads by little has to stand out twice: in scans from different places along the way.
"""

from __future__ import annotations

from rmw_manycore_py.ndt.geometry import poses
from rmw_manycore_py.ndt.geometry.arrays import Pose, ScanPoints
from rmw_manycore_py.ndt.matching.alignment import Alignment
from rmw_manycore_py.ndt.matching.matcher import Matcher
from rmw_manycore_py.ndt.trust.along import Along
from rmw_manycore_py.ndt.trust.judge import RESOLVED_AFTER, PoseJudge, Verdict
from rmw_manycore_py.ndt.trust.motion import Expectation
from rmw_manycore_py.ndt.trust.search import SAME_M, distinct, lead_of_best

EVERY, EVERY_WEAK = 5, 10  # scans, while no place stands out; a tunnel's scans seldom tell


class LookAlong:
    """Looks along while the judge is uncertain.

    :ivar stood_out: how often in a row the place stood out that `look` returned.
    """

    def __init__(self, matcher: Matcher, judge: PoseJudge) -> None:
        self._matcher = matcher
        self._judge = judge
        self._scans = 0
        self.stood_out = 0

    def look(
        self, stamp_s: float, points: ScanPoints, guess: Pose, verdict: Verdict
    ) -> tuple[Alignment, Verdict] | None:
        """Return the place that stands out, and its verdict; None if there is none, or none due."""
        along, expected = verdict.uncertain, verdict.expected
        if along is None or expected is None:
            self._scans = self.stood_out = 0
            return None
        self._scans += 1
        every = EVERY_WEAK if verdict.is_weak else EVERY
        if self.stood_out == 0 and self._scans % every != 1:
            return None
        places = self._places(points, along, expected)
        stands_out, is_clear = lead_of_best(places)
        if not stands_out:
            self.stood_out = 0
            return None
        best = self._matcher.explained(places[0], points)
        is_again = poses.distance_m(best.T_map_sensor, expected.poses[0]) < SAME_M
        self.stood_out = RESOLVED_AFTER if is_clear else (self.stood_out if is_again else 0) + 1
        judged = self._judge.judge(stamp_s, best, guess, stood_out=self.stood_out)
        return (best, judged) if judged.is_believed else None

    def _places(self, points: ScanPoints, along: Along, expected: Expectation) -> list[Alignment]:
        """Return distinct results along the direction, best first."""
        starts = along.places(expected.middle)
        found = [self._matcher.align_once(points, start, only_pose=True) for start in starts]
        return distinct([one for one in found if not one.is_degenerate], SAME_M)
