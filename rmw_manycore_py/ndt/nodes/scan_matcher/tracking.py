# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""Aligns a scan and judges the result: as Autoware does, or robustly with the drive's history.

Robust tracking aligns again from the expected pose if the result of the guess is not believed, then
takes a second look from the guess (matching/second_look.py), and starts a search after consecutive
refused scans (docs/design/ndt_trust.md).
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

OTHER_M, OTHER_RAD = 0.3, np.radians(2.0)  # minimum distance of a second start from the guess
VAIN_LOOKS = 5  # second looks in a row without result, after which none is taken
MAX_LEFT_S = 60.0  # maximum age of a pose left by a previous process


@dataclass(frozen=True)
class ScanAt:
    """A scan (N, 3) [m, base frame], its guess T_map_base and regularization pose."""

    stamp_s: float
    points: ScanPoints
    guess: Pose
    regularization: Pose | None


@dataclass(frozen=True)
class Tracked:
    """Alignment of a scan; `covariance` (6, 6) is the published one."""

    alignment: Alignment
    is_reliable: bool
    covariance: Matrix


class Tracking(Protocol):
    """Common interface of both kinds of tracking.

    `was_activated`: a killed predecessor was activated, so this process resumes.
    """

    was_activated: bool

    def track(self, scan: ScanAt, report: Diagnostics) -> Tracked:
        """Align and judge a scan."""
        ...

    def missed(self, report: Diagnostics) -> None:
        """Report on a scan that could not be aligned."""
        ...

    def map_changed(self, voxel_map: VoxelMap) -> None:
        """Continue in another map."""
        ...

    def activated(self, is_activated: bool) -> None:
        """Restart: the vehicle may be anywhere."""
        ...

    def close(self) -> None:
        """Release resources."""
        ...


class AutowareTracking:
    """Autoware's behaviour: one alignment from the guess, a threshold, no history."""

    was_activated = False

    def __init__(self, matcher: Matcher, parameters: MatcherParameters) -> None:
        self._matcher = matcher
        self._p = parameters

    def track(self, scan: ScanAt, report: Diagnostics) -> Tracked:
        """Align and judge a scan."""
        alignment = self._matcher.align_once(scan.points, scan.guess, scan.regularization)
        reliable = judgement.is_reliable(alignment, self._p, report)
        return Tracked(alignment, reliable, judgement.output_covariance(alignment, self._p))

    def missed(self, report: Diagnostics) -> None:
        """Do nothing."""

    def map_changed(self, voxel_map: VoxelMap) -> None:
        """Do nothing."""

    def activated(self, is_activated: bool) -> None:
        """Do nothing."""

    def close(self) -> None:
        """Do nothing."""


class RobustTracking:
    """Accepts poses on which score, score history and motion agree; recovers by itself."""

    def __init__(self, matcher: Matcher, parameters: MatcherParameters, own: OwnParameters) -> None:
        self._matcher = matcher
        self._p = parameters
        self._judge = PoseJudge(searches=own.recovery_after_scans > 0)
        self._recovery = Recovery(matcher.options, own.recovery_after_scans, own.recovery_radius_m)
        path = Path(own.last_pose_path).expanduser()
        self._last_pose = LastPose(path) if own.last_pose_path else None
        self._second_looks = self._vain_looks = 0
        self.was_activated = False
        left = self._last_pose.read(time.time(), MAX_LEFT_S) if self._last_pose else None
        if left is not None:
            at, self.was_activated = left
            self._judge.begin_at(at)
            self._recovery.hurry()
        self._is_activated = own.activated or self.was_activated

    def track(self, scan: ScanAt, report: Diagnostics) -> Tracked:
        """Align and judge a scan; retry from the expected pose."""
        if self._recovery.take(self._judge):
            report.warn(f"recovery: {self._recovery.note}")
        alignment = self._matcher.align_once(scan.points, scan.guess, scan.regularization)
        verdict = self._judged(scan, alignment)
        if not verdict.is_believed:
            again = self._from_expectation(scan, verdict)
            if again is None and self._judge.may_look_again(verdict):
                again = self._looked_again(scan, alignment)
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
        """Report the state of the recovery."""
        self._report_recovery(report)

    def map_changed(self, voxel_map: VoxelMap) -> None:
        """Adapt the required score to the new map."""
        self._judge.level.map_changed(voxel_map.own_likelihood)
        self._recovery.map_changed(voxel_map)

    def activated(self, is_activated: bool) -> None:
        """Restart: an initial pose was found, or is being searched."""
        self._is_activated = is_activated
        self._judge.forget()
        self._vain_looks = 0
        self._recovery.reset()
        if self._last_pose is not None:
            self._last_pose.forget()

    def close(self) -> None:
        """Stop the search; after a regular shutdown no pose is left."""
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
            alignment = self._matcher.align_once(scan.points, start, scan.regularization)
            verdict = self._judged(scan, alignment)
            if verdict.is_believed:
                return alignment, verdict
        return None

    def _looked_again(self, scan: ScanAt, first: Alignment) -> tuple[Alignment, Verdict] | None:
        """Take a second look from the guess, unless a search looks farther, or looks are vain."""
        is_searching = self._recovery.step in (Step.AROUND, Step.GLOBALLY)
        if is_searching or self._vain_looks >= VAIN_LOOKS:
            return None
        alignment = self._matcher.second_look(
            first,
            scan.points,
            scan.guess,
            scan.regularization,
            convinces=lambda found: self._judged(scan, found).is_believed,
        )
        self._second_looks += alignment.looks > first.looks
        verdict = self._judged(scan, alignment)
        self._vain_looks += not verdict.is_believed
        return (alignment, verdict) if verdict.is_believed else None

    def _judged(self, scan: ScanAt, alignment: Alignment) -> Verdict:
        return self._judge.judge(scan.stamp_s, alignment, scan.guess)

    def _believe(self, scan: ScanAt, alignment: Alignment) -> None:
        self._judge.believe(scan.stamp_s, alignment, scan.guess)
        self._recovery.believed()
        self._vain_looks = 0
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
        report.value("second_looks", self._second_looks)
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
