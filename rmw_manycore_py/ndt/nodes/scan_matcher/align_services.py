# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""`ndt_align_srv`: searches for the likeliest pose around a given one, between scans.

Where the given pose is very uncertain, the map is searched for the place instead (trust/search.py).

The service type is that of current Autoware; `ndt_align_tier4_srv` uses that of Autoware Universe
until 2024. A waiting service callback is a coroutine, so that the executor keeps handling guesses
and scans, and scans are matched between two alignments of the search.
"""

from __future__ import annotations

from collections.abc import Callable, Generator, Iterator, Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np
from autoware_internal_localization_msgs.srv import PoseWithCovarianceStamped as AlignService
from rclpy.callback_groups import MutuallyExclusiveCallbackGroup
from rclpy.node import Node
from rclpy.task import Future
from tier4_localization_msgs.srv import PoseWithCovarianceStamped as Tier4AlignService

from rmw_manycore_py.errors import ManycoreError
from rmw_manycore_py.ndt.geometry.arrays import Matrix, Points
from rmw_manycore_py.ndt.matching.alignment import Alignment
from rmw_manycore_py.ndt.matching.initial_pose import Particle, particles
from rmw_manycore_py.ndt.messages.conversions import (
    PoseError,
    covariance_of,
    matrix_of,
    pose_with_covariance,
    seconds,
)
from rmw_manycore_py.ndt.nodes.scan_matcher.diagnostics import Diagnostics
from rmw_manycore_py.ndt.nodes.scan_matcher.frame_tree import FrameError, FrameTree
from rmw_manycore_py.ndt.nodes.scan_matcher.map_supply import MapSupply
from rmw_manycore_py.ndt.nodes.scan_matcher.matching_thread import MatchingThread
from rmw_manycore_py.ndt.nodes.scan_matcher.parameters import MatcherParameters
from rmw_manycore_py.ndt.nodes.scan_matcher.rejected import Rejected
from rmw_manycore_py.ndt.trust.search import Region

SEED = 0
LOST_M = 10.0  # standard deviation of a pose that is no guess
LOST_DEVIATIONS = 3.0  # searched around such a pose


@dataclass(frozen=True)
class AlignParts:
    """Functions of the node that a search uses, called on the matching thread.

    :param take_new_map: swaps in a map built in the background.
    :param newest_scan: returns the points (N, 3) in the base frame; None before the first scan.
    :param align: aligns points to the map from a guess (4, 4).
    :param search: searches a region of the map for the place of points, step by step.
    :param show: publishes the evaluated poses.
    """

    parameters: MatcherParameters
    frames: FrameTree
    map: MapSupply
    thread: MatchingThread
    take_new_map: Callable[[], None]
    newest_scan: Callable[[], Points | None]
    align: Callable[[Points, Matrix], Alignment]
    search: Callable[[Points, Region], Generator[bool, None, Alignment]]
    show: Callable[[Any, Sequence[Particle]], None]


class AlignServices:
    """Serves both types, one request at a time."""

    def __init__(self, node: Node, parts: AlignParts) -> None:
        self._node = node
        self._parts = parts
        self._p = parts.parameters
        self._report = Diagnostics(node, "ndt_align_service_status")
        one_at_a_time = MutuallyExclusiveCallbackGroup()
        for kind, name in (
            (AlignService, "ndt_align_srv"),
            (Tier4AlignService, "ndt_align_tier4_srv"),
        ):
            node.create_service(kind, name, self._on_align, callback_group=one_at_a_time)

    async def _on_align(self, request: Any, response: Any) -> Any:
        report = self._report
        report.clear()
        now = self._now()
        report.value("service_call_time_stamp", seconds(now))
        try:
            T_map_base, covariance = self._pose_of(request.pose_with_covariance, report)
            await self._parts.map.update_around(float(T_map_base[0, 3]), float(T_map_base[1, 3]))
            self._parts.map.report_loader(report)
            best = await self._searched(T_map_base, covariance)
            report.value("best_particle_score", best.score)
            self._answer(response, request.pose_with_covariance, covariance, best)
        except (Rejected, ManycoreError, PoseError, FrameError) as why:
            report.warn(f"ndt_align_srv failed: {why}")
            response.success = False
        report.value("is_succeed_service", bool(response.success))
        report.publish(now)
        return response

    def _pose_of(self, guess: Any, report: Diagnostics) -> tuple[Matrix, Matrix]:
        """Return the pose (4, 4) to search around in the map frame, and its covariance (6, 6)."""
        T_map_frame = np.eye(4)
        if guess.header.frame_id != self._p.map_frame:
            try:
                T_map_frame = self._parts.frames.lookup(self._p.map_frame, guess.header.frame_id)
            except FrameError:
                report.value("is_succeed_transform_initial_pose", False)
                raise
        report.value("is_succeed_transform_initial_pose", True)
        covariance = covariance_of(guess)
        if not np.isfinite(covariance).all():
            raise Rejected("the covariance of the pose is not finite")
        return T_map_frame @ matrix_of(guess.pose.pose), covariance

    async def _searched(self, T_map_base: Matrix, covariance: Matrix) -> Particle:
        """Run the search on the matching thread; raise its error, if any."""
        found = Future()
        self._parts.thread.post_steps(self._steps(T_map_base, covariance, found))
        best: Particle | Exception = await found
        if isinstance(best, Exception):
            raise best
        return best

    def _steps(self, T_map_base: Matrix, covariance: Matrix, found: Future) -> Iterator[bool]:
        """Search step by step; the executor completes `found` with the best result or an error."""
        result: Particle | Exception
        try:
            result = yield from self._search(T_map_base, covariance)
        except (Rejected, ManycoreError) as why:
            result = why
        executor = self._node.executor
        if executor is not None:
            executor.create_task(found.set_result, result)

    def _search(self, T_map_base: Matrix, covariance: Matrix) -> Generator[bool, None, Particle]:
        """Wait for the map of the area, then align from one guess after the other."""
        parts = self._parts
        parts.take_new_map()
        while not parts.map.is_settled:
            yield False
            parts.take_new_map()
        self._report.value("is_set_map_points", parts.map.is_set)
        if not parts.map.is_set:
            raise Rejected(f"there is no map yet: {parts.map.what_is_missing()}")
        scan = parts.newest_scan()
        self._report.value("is_set_sensor_points", scan is not None)
        if scan is None:
            raise Rejected("no scan received yet: check points_raw")
        away_m = float(np.sqrt(covariance[:2, :2].diagonal().max()))
        if away_m > LOST_M:
            region = Region(T_map_base, LOST_DEVIATIONS * away_m, any_yaw=True)
            return Particle(T_map_base, (yield from parts.search(scan, region)))
        tried = []
        for particle in particles(
            lambda T: parts.align(scan, T),
            T_map_base,
            covariance,
            self._p.particles,
            self._p.startup_trials,
            np.random.default_rng(SEED),
        ):
            tried.append(particle)
            yield True
        parts.show(self._now(), tried)
        best = max(tried, key=lambda particle: particle.score)
        if not np.isfinite(best.alignment.T_map_sensor).all():
            raise Rejected("no alignment has a finite result")
        return best

    def _answer(self, response: Any, guess: Any, covariance: Matrix, best: Particle) -> None:
        response.success = True
        response.reliable = best.score > self._p.min_nearest_voxel_likelihood
        if not response.reliable:
            self._report.warn(
                f"the best of {self._p.particles} results has a score of {best.score:.3f}"
            )
        response.pose_with_covariance = pose_with_covariance(
            best.alignment.T_map_sensor, covariance, guess.header.stamp, self._p.map_frame
        )

    def _now(self) -> Any:
        return self._node.get_clock().now().to_msg()
