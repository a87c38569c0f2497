# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""Aligns a scan and judges the result: as Autoware does, or robustly with the drive's history.

Robust tracking looks again at a refused scan (trust/looks.py), and starts a search after several
refused ones in a row (docs/design/ndt_trust.md).
"""

from __future__ import annotations

import time
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Protocol

from rmw_manycore_py.ndt.geometry.arrays import Matrix
from rmw_manycore_py.ndt.matching.alignment import Alignment
from rmw_manycore_py.ndt.matching.matcher import Matcher
from rmw_manycore_py.ndt.matching.voxel_map import VoxelMap
from rmw_manycore_py.ndt.nodes.scan_matcher import reliability
from rmw_manycore_py.ndt.nodes.scan_matcher.diagnostics import Diagnostics
from rmw_manycore_py.ndt.nodes.scan_matcher.parameters import MatcherParameters, OwnParameters
from rmw_manycore_py.ndt.trust.judge import PoseJudge, Verdict
from rmw_manycore_py.ndt.trust.last_pose import LastPose
from rmw_manycore_py.ndt.trust.look_along import LookAlong
from rmw_manycore_py.ndt.trust.looks import Looks, ScanAt
from rmw_manycore_py.ndt.trust.motion import Believed
from rmw_manycore_py.ndt.trust.recovery import Recovery, Step
from rmw_manycore_py.ndt.trust.repeats import RepeatedScans

MAX_LEFT_S = 60.0  # maximum age of a pose left by a previous process


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
        reliable = reliability.is_reliable(alignment, self._p, report)
        return Tracked(alignment, reliable, reliability.output_covariance(alignment, self._p))

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
        self._repeats = RepeatedScans()
        self._looks = Looks(matcher, self._judge)
        self._along = LookAlong(matcher, self._judge)
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
            self._looks.hope()
        is_searching = self._recovery.step in (Step.AROUND, Step.GLOBALLY)
        alignment, verdict = self._looks.look(scan, is_searching=is_searching)
        found = None if is_searching else self._along.look(scan, verdict)
        if found is None:
            alignment = replace(alignment, T_map_sensor=verdict.corrected(alignment.T_map_sensor))
        else:
            alignment, verdict = found
        if repeated := self._repeats.why_refused(scan.points, verdict.expected):
            verdict = replace(verdict, why=repeated)
        self._report(alignment, verdict, report)
        if verdict.is_believed:
            self._believe(scan, alignment, 0 if found is None else self._along.stood_out)
        else:
            is_first = verdict.expected is None
            at = scan.guess if verdict.expected is None else verdict.expected.poses[0]
            self._recovery.refused(scan.stamp_s, scan.points, scan.guess, at, is_first=is_first)
        self._report_recovery(report)
        covariance = verdict.covariance(reliability.output_covariance(alignment, self._p))
        return Tracked(alignment, verdict.is_believed, covariance)

    def missed(self, report: Diagnostics) -> None:
        """Report the state of the recovery."""
        self._report_recovery(report)

    def map_changed(self, voxel_map: VoxelMap) -> None:
        """Adapt the required score to the new map."""
        self._judge.level.map_changed(voxel_map.own_score)
        self._along.map_changed(voxel_map)
        self._recovery.map_changed(voxel_map)

    def activated(self, is_activated: bool) -> None:
        """Restart: an initial pose was found, or is being searched."""
        self._is_activated = is_activated
        self._judge.forget()
        self._looks.hope()
        self._recovery.reset()
        if self._last_pose is not None:
            self._last_pose.forget()

    def close(self) -> None:
        """Stop the search; after a regular shutdown no pose is left."""
        self._recovery.close()
        if self._last_pose is not None:
            self._last_pose.forget()
            self._last_pose.close()

    def _believe(self, scan: ScanAt, alignment: Alignment, stood_out: int) -> None:
        self._judge.believe(scan.stamp_s, alignment, scan.guess, stood_out=stood_out)
        self._recovery.believed()
        self._looks.hope()
        if self._last_pose is not None:
            at = Believed(scan.stamp_s, alignment.T_map_sensor, scan.guess)
            self._last_pose.write(time.time(), at, self._is_activated)

    def _report(self, alignment: Alignment, verdict: Verdict, report: Diagnostics) -> None:
        report.value("iteration_num", alignment.iterations)
        report.value("transform_probability", alignment.transform_probability)
        likelihood = alignment.nearest_voxel_likelihood
        report.value("nearest_voxel_transformation_likelihood", likelihood)
        report.value("score_level", round(verdict.level, 4))
        report.value("explained_score", round(alignment.explained_score, 4))
        report.value("share_of_points_in_map", round(alignment.share_in_map, 4))
        report.value("is_sure", verdict.is_sure)
        report.value("second_looks", self._looks.second_looks)
        if not verdict.is_believed:
            report.warn(verdict.why)

    def _report_recovery(self, report: Diagnostics) -> None:
        report.value("recovery_step", self._recovery.step.value)
        if self._recovery.note:
            report.value("recovery_note", self._recovery.note)
        if self._recovery.step is not Step.TRACKING:
            report.note(f"recovery: {self._recovery.step.value}")
