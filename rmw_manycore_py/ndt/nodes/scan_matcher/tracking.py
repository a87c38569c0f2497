# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""Aligning a scan and judging the result: as Autoware does, or by all that is known of the drive.

The latter aligns again from where the vehicle should be if the result of the guess is not believed,
and has a search look farther when scans are refused in a row (docs/design/ndt_trust.md).
"""

from __future__ import annotations

import time
from dataclasses import dataclass
from pathlib import Path
from typing import Protocol

import numpy as np

from rmw_manycore_py.ndt.geometry import poses
from rmw_manycore_py.ndt.geometry.arrays import Matrix, Pose, ScanPoints
from rmw_manycore_py.ndt.matching.alignment import Alignment
from rmw_manycore_py.ndt.matching.matcher import Matcher
from rmw_manycore_py.ndt.matching.voxel_map import VoxelMap
from rmw_manycore_py.ndt.nodes.scan_matcher import judgement
from rmw_manycore_py.ndt.nodes.scan_matcher.diagnostics import Diagnostics
from rmw_manycore_py.ndt.nodes.scan_matcher.parameters import MatcherParameters, OwnParameters
from rmw_manycore_py.ndt.trust.judge import PoseJudge, Verdict
from rmw_manycore_py.ndt.trust.last_pose import LastPose
from rmw_manycore_py.ndt.trust.motion import Believed
from rmw_manycore_py.ndt.trust.recovery import Recovery, Step

OTHER_M, OTHER_RAD = 0.3, np.radians(2.0)  # a start so far from the guess is worth another try
MAX_LEFT_S = 60.0  # age of a pose that an earlier process left


@dataclass(frozen=True)
class ScanAt:
    """A scan (N, 3) [m, base frame], its guess T_map_base and regularization pose."""

    stamp_s: float
    points: ScanPoints
    guess: Pose
    regularization: Pose | None


@dataclass(frozen=True)
class Tracked:
    """The alignment of a scan; `covariance` (6, 6) is the output's."""

    alignment: Alignment
    is_reliable: bool
    covariance: Matrix


class Tracking(Protocol):
    """What the node has of either.

    `was_activated`: an earlier process that was killed was, so this one goes on.
    """

    was_activated: bool

    def track(self, scan: ScanAt, report: Diagnostics) -> Tracked:
        """Align and judge a scan."""
        ...

    def missed(self, report: Diagnostics) -> None:
        """Report on a scan that could not be aligned."""
        ...

    def map_changed(self, voxel_map: VoxelMap) -> None:
        """Go on in another map."""
        ...

    def activated(self, is_activated: bool) -> None:
        """Begin anew: the vehicle may be anywhere."""
        ...

    def close(self) -> None:
        """Give back what it holds."""
        ...


class AutowareTracking:
    """Autoware's: one alignment from the guess, a threshold, and nothing remembered."""

    was_activated = False

    def __init__(self, matcher: Matcher, parameters: MatcherParameters) -> None:
        self._matcher = matcher
        self._p = parameters

    def track(self, scan: ScanAt, report: Diagnostics) -> Tracked:
        """Align and judge a scan."""
        alignment = self._matcher.align(scan.points, scan.guess, scan.regularization)
        reliable = judgement.is_reliable(alignment, self._p, report)
        return Tracked(alignment, reliable, judgement.output_covariance(alignment, self._p))

    def missed(self, report: Diagnostics) -> None:
        """Nothing is reported."""

    def map_changed(self, voxel_map: VoxelMap) -> None:
        """Nothing is known of maps."""

    def activated(self, is_activated: bool) -> None:
        """Nothing is remembered."""

    def close(self) -> None:
        """Nothing is held."""


class RobustTracking:
    """Believes what score, its course and the motion agree on, and finds back by itself."""

    def __init__(self, matcher: Matcher, parameters: MatcherParameters, own: OwnParameters) -> None:
        self._matcher = matcher
        self._p = parameters
        self._judge = PoseJudge(searches=own.recovery_after_scans > 0)
        self._recovery = Recovery(matcher.options, own.recovery_after_scans, own.recovery_radius_m)
        path = Path(own.last_pose_path).expanduser()
        self._last_pose = LastPose(path) if own.last_pose_path else None
        self.was_activated = False
        left = self._last_pose.read(time.time(), MAX_LEFT_S) if self._last_pose else None
        if left is not None:
            at, self.was_activated = left
            self._judge.begin_at(at)
            self._recovery.hurry()
        self._is_activated = own.activated or self.was_activated

    def track(self, scan: ScanAt, report: Diagnostics) -> Tracked:
        """Align and judge a scan; try again from where the vehicle should be."""
        if self._recovery.take(self._judge):
            report.warn(f"recovery: {self._recovery.note}")
        alignment = self._matcher.align(scan.points, scan.guess, scan.regularization)
        verdict = self._judge.judge(scan.stamp_s, alignment, scan.guess)
        if not verdict.is_believed:
            again = self._from_expectation(scan, verdict)
            if again is not None:
                alignment, verdict = again
        self._report(alignment, verdict, report)
        if verdict.is_believed:
            self._believe(scan, alignment)
        else:
            expected = scan.guess if verdict.expected is None else verdict.expected.poses[0]
            self._recovery.refused(scan.stamp_s, scan.points, scan.guess, expected)
        self._report_recovery(report)
        covariance = verdict.covariance(judgement.output_covariance(alignment, self._p))
        return Tracked(alignment, verdict.is_believed, covariance)

    def missed(self, report: Diagnostics) -> None:
        """Report where the recovery is, also for a scan that could not be aligned."""
        self._report_recovery(report)

    def map_changed(self, voxel_map: VoxelMap) -> None:
        """Demand what the new map's own scores allow."""
        self._judge.level.map_changed(voxel_map.own_likelihood)
        self._recovery.map_changed(voxel_map)

    def activated(self, is_activated: bool) -> None:
        """Begin anew: a first pose was found, or one is looked for."""
        self._is_activated = is_activated
        self._judge.forget()
        self._recovery.reset()
        if self._last_pose is not None:
            self._last_pose.forget()

    def close(self) -> None:
        """End the search; a node that ends as it should leaves no pose."""
        self._recovery.close()
        if self._last_pose is not None:
            self._last_pose.forget()
            self._last_pose.close()

    def _from_expectation(self, scan: ScanAt, before: Verdict) -> tuple[Alignment, Verdict] | None:
        tried = [scan.guess]
        for start in [] if before.expected is None else before.expected.poses:
            if any(_is_near(start, other) for other in tried):
                continue
            tried.append(start)
            alignment = self._matcher.align(scan.points, start, scan.regularization)
            verdict = self._judge.judge(scan.stamp_s, alignment, scan.guess)
            if verdict.is_believed:
                return alignment, verdict
        return None

    def _believe(self, scan: ScanAt, alignment: Alignment) -> None:
        self._judge.believe(scan.stamp_s, alignment, scan.guess)
        self._recovery.believed()
        if self._last_pose is not None:
            at = Believed(scan.stamp_s, alignment.T_map_sensor, scan.guess)
            self._last_pose.write(time.time(), at, self._is_activated)

    def _report(self, alignment: Alignment, verdict: Verdict, report: Diagnostics) -> None:
        report.value("iteration_num", alignment.iterations)
        report.value("transform_probability", alignment.transform_probability)
        likelihood = alignment.nearest_voxel_likelihood
        report.value("nearest_voxel_transformation_likelihood", likelihood)
        report.value("score_level", round(verdict.level, 4))
        report.value("share_of_points_in_map", round(alignment.share_in_map, 4))
        report.value("is_sure", verdict.is_sure)
        if not verdict.is_believed:
            report.warn(verdict.why)

    def _report_recovery(self, report: Diagnostics) -> None:
        report.value("recovery_step", self._recovery.step.value)
        if self._recovery.note:
            report.value("recovery_note", self._recovery.note)
        if self._recovery.step is not Step.TRACKING:
            report.note(f"recovery: {self._recovery.step.value}")


def _is_near(T: Pose, other: Pose) -> bool:
    return poses.distance_m(T, other) < OTHER_M and poses.angle_rad(T, other) < OTHER_RAD
