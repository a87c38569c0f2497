# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""Aligns a scan from several places along an uncertain direction; believes what stands out.

A place that leads by little has to stand out twice: in scans from different places along the way.
The places share the points of the scan, on the calling thread: a look costs as much CPU time as
some ordinary alignments, and waits for no worker.
"""

from __future__ import annotations

from rmw_manycore_py.ndt.geometry import poses
from rmw_manycore_py.ndt.geometry.arrays import scan_points
from rmw_manycore_py.ndt.matching.alignment import Alignment
from rmw_manycore_py.ndt.matching.matcher import Matcher
from rmw_manycore_py.ndt.matching.serial_matcher import SerialMatcher
from rmw_manycore_py.ndt.matching.voxel_map import VoxelMap
from rmw_manycore_py.ndt.trust.along import Along
from rmw_manycore_py.ndt.trust.judge import RESOLVED_AFTER, PoseJudge, Verdict
from rmw_manycore_py.ndt.trust.looks import ScanAt
from rmw_manycore_py.ndt.trust.motion import Expectation
from rmw_manycore_py.ndt.trust.search import SAME_M, distinct, lead_of_best

EVERY, EVERY_WEAK = 5, 10  # scans, while no place stands out; a tunnel's scans seldom tell
COST = 8  # of a look, in alignments of the whole scan


class LookAlong:
    """Looks along while the judge is uncertain.

    :ivar stood_out: how often in a row the place stood out that `look` returned.
    """

    def __init__(self, matcher: Matcher, judge: PoseJudge) -> None:
        self._matcher = matcher
        self._here = SerialMatcher(matcher.options)
        self._judge = judge
        self._scans = 0
        self.stood_out = 0

    def map_changed(self, voxel_map: VoxelMap) -> None:
        """Look in this map from now on."""
        self._here.set_map(voxel_map)

    def look(self, scan: ScanAt, verdict: Verdict) -> tuple[Alignment, Verdict] | None:
        """Return the place that stands out, and its verdict; None if there is none, or none due."""
        along, expected = verdict.uncertain, verdict.expected
        if along is None or expected is None:
            self._scans = self.stood_out = 0
            return None
        self._scans += 1
        every = EVERY_WEAK if verdict.weak else EVERY
        if self.stood_out == 0 and self._scans % every != 1:
            return None
        places = self._places(scan, along, expected)
        stands_out, is_clear = lead_of_best(places)
        if not stands_out:
            self.stood_out = 0
            return None
        whole = self._matcher.align_once(scan.points, places[0].T_map_sensor, scan.regularization)
        whole = self._matcher.raised(whole, scan.points)
        best = self._matcher.explained(whole, scan.points)
        is_again = poses.distance_m(best.T_map_sensor, expected.poses[0]) < SAME_M
        self.stood_out = RESOLVED_AFTER if is_clear else (self.stood_out if is_again else 0) + 1
        judged = self._judge.judge(scan.stamp_s, best, scan.guess, stood_out=self.stood_out)
        return (best, judged) if judged.is_believed else None

    def _places(self, scan: ScanAt, along: Along, expected: Expectation) -> list[Alignment]:
        """Return distinct results along the direction, best first."""
        starts = along.places(expected.middle)
        some = scan_points(scan.points[:: -(-len(starts) // COST)])
        found = [self._here.align_once(some, start, only_pose=True) for start in starts]
        ends = [one for one in found if not one.is_degenerate]
        return distinct(ends, SAME_M, lambda place: place.fit)
