# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""`ndt_scan_matcher`: pose of the vehicle from LiDAR scans, with Autoware's interface."""

from __future__ import annotations

from contextlib import ExitStack
from functools import partial
from typing import Any

import numpy as np
import rclpy
from rclpy.node import Node
from rclpy.qos import DurabilityPolicy, QoSProfile, ReliabilityPolicy
from sensor_msgs.msg import PointCloud2
from std_srvs.srv import SetBool

from rmw_manycore_py.errors import ManycoreError
from rmw_manycore_py.ndt.geometry import poses
from rmw_manycore_py.ndt.geometry.arrays import Matrix, Points
from rmw_manycore_py.ndt.geometry.deskewing import deskewed
from rmw_manycore_py.ndt.matching.alignment import Alignment
from rmw_manycore_py.ndt.matching.voxel_map import VoxelMap
from rmw_manycore_py.ndt.messages.conversions import seconds
from rmw_manycore_py.ndt.nodes.scan_matcher.align_services import AlignParts, AlignServices
from rmw_manycore_py.ndt.nodes.scan_matcher.cluster_memory import ClusterMemory
from rmw_manycore_py.ndt.nodes.scan_matcher.diagnostics import Diagnostics
from rmw_manycore_py.ndt.nodes.scan_matcher.frame_tree import FrameTree
from rmw_manycore_py.ndt.nodes.scan_matcher.loaded_map import LoadedMap
from rmw_manycore_py.ndt.nodes.scan_matcher.lost import search_region
from rmw_manycore_py.ndt.nodes.scan_matcher.map_supply import MapSupply
from rmw_manycore_py.ndt.nodes.scan_matcher.markers import PoseMarkers
from rmw_manycore_py.ndt.nodes.scan_matcher.matcher_options import matcher_options
from rmw_manycore_py.ndt.nodes.scan_matcher.matchers import make_matcher
from rmw_manycore_py.ndt.nodes.scan_matcher.matching_thread import MatchingThread
from rmw_manycore_py.ndt.nodes.scan_matcher.matching_trace import MatchingTrace
from rmw_manycore_py.ndt.nodes.scan_matcher.outputs import MatcherOutputs
from rmw_manycore_py.ndt.nodes.scan_matcher.parameters import MatcherParameters, OwnParameters
from rmw_manycore_py.ndt.nodes.scan_matcher.pose_buffer import Interpolated, NoPoseError
from rmw_manycore_py.ndt.nodes.scan_matcher.pose_inputs import PoseInputs
from rmw_manycore_py.ndt.nodes.scan_matcher.real_time import schedule_in_real_time
from rmw_manycore_py.ndt.nodes.scan_matcher.rejected import Rejected
from rmw_manycore_py.ndt.nodes.scan_matcher.scan_inbox import ScanInbox
from rmw_manycore_py.ndt.nodes.scan_matcher.scan_points import Scan, ScanPoints
from rmw_manycore_py.ndt.nodes.scan_matcher.stage_times import StageTimes
from rmw_manycore_py.ndt.nodes.scan_matcher.steps import report_steps
from rmw_manycore_py.ndt.nodes.scan_matcher.tracking import (
    AutowareTracking,
    RobustTracking,
    Tracked,
    Tracking,
)
from rmw_manycore_py.ndt.nodes.support.clock import clock_s
from rmw_manycore_py.ndt.nodes.support.declared import declare
from rmw_manycore_py.ndt.nodes.support.running import run_node
from rmw_manycore_py.ndt.nodes.support.watched import watched
from rmw_manycore_py.ndt.trust.looks import ScanAt
from rmw_manycore_py.process.cpu_time import tree_cpu_s

STATUSES = ("scan_matching_status", "map_update_status", "trigger_node_service_status")
MAP_UPDATE_PERIOD_S = 1.0
SCAN_DEPTH = 5  # deep enough that bursts are counted as skipped, not lost in a queue


class NdtScanMatcher(Node):
    """Matches each scan to the map around the vehicle.

    The executor's thread handles guesses, scans and requests; a second thread owns matcher and map.
    """

    def __init__(self) -> None:
        # At shutdown, newer releases of rclpy destroy nodes whose construction is under way.
        self._to_close = ExitStack()
        super().__init__("ndt_scan_matcher")
        self._p = declare(self, MatcherParameters)
        self._own = declare(self, OwnParameters)
        options = matcher_options(self._p, self._own)
        self._matcher = make_matcher(options, self._own.worker_cpus)
        self._to_close.callback(self._matcher.close)
        schedule_in_real_time(self._own.realtime_priority, self._matcher.worker_pids)
        self._tracking = self._make_tracking()
        self._to_close.callback(self._tracking.close)
        self._memory = ClusterMemory(self, self._matcher)
        self._trace = MatchingTrace(self, self._matcher)
        self._map = MapSupply(
            self, options, self._p, self._own, self._match_to, lambda: self._thread.wake()
        )
        self._to_close.callback(self._map.close)
        self._frames = FrameTree()
        self._scan_points = ScanPoints(self._p, self._own, self._frames)
        self._is_activated = self._own.activated or self._tracking.was_activated
        self._scan: Points | None = None
        self._rejected_in_a_row = 0
        self._skipped = 0
        self._outputs = MatcherOutputs(self, self._p.map_frame, self._p.ndt_base_frame)
        self._loaded_map = LoadedMap(self, self._p.map_frame, self._map)
        self._markers = PoseMarkers(self, self._p.map_frame)
        self._diagnostics = {name: Diagnostics(self, name) for name in STATUSES}
        self._poses = PoseInputs(
            self, self._p, self._own, lambda: self._is_activated, self._on_guess
        )
        self._thread = MatchingThread(
            ScanInbox(self._need_not_wait, self._own.guess_wait_s),
            self._on_turn_of_scan,
            self._on_skipped,
            lambda: not self.context.ok(),
            rclpy.try_shutdown,
        )
        self._to_close.callback(self._thread.close)
        self._listen()
        AlignServices(
            self,
            AlignParts(
                self._p,
                self._frames,
                self._map,
                self._thread,
                self._take_new_map,
                lambda: self._scan,
                self._aligned_to,
                partial(search_region, self._matcher, self._memory),
                self._markers.particles,
            ),
        )

    def _make_tracking(self) -> Tracking:
        if self._own.behaviour == "autoware":
            return AutowareTracking(self._matcher, self._p)
        return RobustTracking(self._matcher, self._p, self._own)

    def _listen(self) -> None:
        sensor = QoSProfile(depth=SCAN_DEPTH, reliability=ReliabilityPolicy.BEST_EFFORT)
        kept = QoSProfile(depth=1, durability=DurabilityPolicy.TRANSIENT_LOCAL)
        self.create_subscription(PointCloud2, "points_raw", self._on_scan, sensor)
        self.create_subscription(
            PointCloud2,
            "pointcloud_map",
            self._map.on_message,
            kept,
            event_callbacks=watched(self, "pointcloud_map"),
        )
        self._frames.listen(self)
        self.create_service(SetBool, "trigger_node_srv", self._on_trigger)
        self.create_timer(MAP_UPDATE_PERIOD_S, self._on_timer)

    def destroy_node(self) -> None:
        """Release map and workers; raise the error that ended the matching thread, if any."""
        try:
            self._to_close.close()
        finally:
            super().destroy_node()

    def _on_guess(self, T_map_base: Matrix) -> None:
        self._map.vehicle_is_at(float(T_map_base[0, 3]), float(T_map_base[1, 3]))
        self._thread.wake()

    def _on_scan(self, message: Any) -> None:
        stamp_s = seconds(message.header.stamp)
        self._poses.guesses.note_scan(stamp_s)
        self._trace.arrived(message)
        self._thread.put_scan(message, stamp_s)

    def _need_not_wait(self, stamp_s: float) -> bool:
        return not self._is_activated or self._poses.guesses.is_there(stamp_s)

    def _on_skipped(self, message: Any) -> None:
        self._trace.skipped(message)
        self._skipped += 1
        report = self._diagnostics["scan_matching_status"]
        report.clear()
        report.value("topic_time_stamp", seconds(message.header.stamp))
        report.value("skipped_scans", self._skipped)
        report.warn("skipped: a newer scan has arrived")
        report.publish(message.header.stamp)

    def _on_turn_of_scan(self, message: Any) -> None:
        self._trace.resume(message)
        report = self._diagnostics["scan_matching_status"]
        report.clear()
        try:
            reliable = self._match(message, report)
        except (Rejected, ManycoreError) as why:
            report.warn(str(why))
            self._tracking.missed(report)
            reliable = False
        failed = self._is_activated and not reliable
        self._rejected_in_a_row = self._rejected_in_a_row + 1 if failed else 0
        report.value("skipping_publish_num", self._rejected_in_a_row)
        if self._rejected_in_a_row >= self._p.skipping_publish_num:
            report.note(f"{self._rejected_in_a_row} consecutive scans without a pose")
        report.value("skipped_scans", self._skipped)
        report.value("cpu_time_s", round(tree_cpu_s(), 2))
        report.publish(message.header.stamp)

    def _match(self, message: Any, report: Diagnostics) -> bool:
        """Run Autoware's steps; the result is published even if unreliable."""
        stages = StageTimes()
        stamp, stamp_s = message.header.stamp, seconds(message.header.stamp)
        report.value("topic_time_stamp", stamp_s)
        scan = self._scan_points.of(message, clock_s(self), report)
        self._scan = scan.points
        stages.end("decode")
        self._require_activation(report)
        guess = self._guess_at(stamp_s, report)
        self._scan = points = self._deskewed(scan, stamp_s, guess, report)
        stages.end("deskew")
        self._take_new_map()
        self._require_map(guess, report)
        self._memory.make_room_for_scan(len(points))
        stages.end("map")
        tracked = self._tracked(stamp_s, points, guess, report)
        stages.end("match")
        self._report_alignment(tracked.alignment, guess, report)
        if tracked.is_reliable:
            self._outputs.accepted_pose(stamp, tracked.alignment.T_map_sensor, tracked.covariance)
        self._report_time(stamp, stages.total_ms, report)
        self._publish_details(stamp, points, tracked.alignment, guess)
        stages.end("publish")
        stages.report(report)
        return tracked.is_reliable

    def _require_activation(self, report: Diagnostics) -> None:
        report.value("is_activated", self._is_activated)
        if not self._is_activated:
            raise Rejected("Node is not activated: call trigger_node_srv")

    def _guess_at(self, stamp_s: float, report: Diagnostics) -> Interpolated:
        try:
            guess = self._poses.guesses.at(stamp_s)
        except NoPoseError as why:
            report.value("is_succeed_interpolate_initial_pose", False)
            raise Rejected(
                f"Couldn't interpolate pose: {why}. Check that ekf_pose_with_covariance is "
                "published, with stamps near those of the scans and without jumps"
            ) from why
        report.value("is_succeed_interpolate_initial_pose", True)
        report.value("initial_pose_age", round(guess.age_s, 4))
        return guess

    def _deskewed(
        self, scan: Scan, stamp_s: float, guess: Interpolated, report: Diagnostics
    ) -> Points:
        """Return the points (N, 3) as seen at the scan's stamp, if their times are known."""
        if scan.times_s is None:
            return scan.points
        motion = self._poses.guesses.motion_until(stamp_s, guess.T)
        report.value("is_deskewed", motion is not None)
        if motion is None:
            report.note("not deskewed: the guesses before the scan do not determine the motion")
            return scan.points
        T, duration_s = motion
        return deskewed(scan.points, scan.times_s / duration_s, T)

    def _require_map(self, guess: Interpolated, report: Diagnostics) -> None:
        report.value("is_set_map_points", self._map.is_set)
        if not self._map.is_set:
            raise Rejected(f"there is no map yet: {self._map.what_is_missing()}")
        if self._map.is_leaving(float(guess.T[0, 3]), float(guess.T[1, 3])):
            report.note("Lidar has gone out of the map range")

    def _tracked(
        self, stamp_s: float, points: Points, guess: Interpolated, report: Diagnostics
    ) -> Tracked:
        regularization = self._poses.regularization_at(stamp_s, guess.T, report)
        tracked = self._tracking.track(ScanAt(stamp_s, points, guess.T, regularization), report)
        if not np.isfinite(tracked.alignment.T_map_sensor).all():
            raise Rejected(f"the alignment has no finite result: {tracked.alignment.why}")
        return tracked

    def _report_alignment(
        self, alignment: Alignment, guess: Interpolated, report: Diagnostics
    ) -> None:
        report_steps(alignment, report)
        distance_m = poses.distance_m(guess.T, alignment.T_map_sensor)
        report.value("distance_initial_to_result", distance_m)
        if distance_m > self._p.result_distance_m:
            report.warn(f"distance_initial_to_result is too large ({distance_m:.2f} m)")

    def _report_time(self, stamp: Any, exe_time_ms: float, report: Diagnostics) -> None:
        report.value("execution_time", round(exe_time_ms, 3))
        if exe_time_ms > self._p.critical_exe_time_ms:
            report.warn(f"NDT exe time is too long (took {exe_time_ms:.1f} ms)")
        self._outputs.number("exe_time_ms", stamp, exe_time_ms)

    def _publish_details(
        self, stamp: Any, points: Points, alignment: Alignment, guess: Interpolated
    ) -> None:
        self._outputs.result(stamp, alignment, guess)
        self._markers.alignment(stamp, alignment.path)
        self._publish_clouds(stamp, points, alignment.T_map_sensor)

    def _publish_clouds(self, stamp: Any, points: Points, T_map_base: Matrix) -> None:
        self._outputs.cloud("points_aligned", stamp, points, T_map_base)
        self._outputs.scored_cloud(stamp, points, T_map_base, self._matcher.point_scores)
        if not self._p.no_ground:
            return
        height_m = points @ T_map_base[2, :3]
        above = points[height_m > self._p.ground_margin_m]
        self._outputs.cloud("points_aligned_no_ground", stamp, above, T_map_base)
        score = self._matcher.score(above, T_map_base)
        prefix = "no_ground_"
        self._outputs.number(f"{prefix}transform_probability", stamp, score.transform_probability)
        self._outputs.number(
            f"{prefix}nearest_voxel_transformation_likelihood",
            stamp,
            score.nearest_voxel_likelihood,
        )

    def _match_to(self, voxel_map: VoxelMap) -> None:
        """Swap in a map; the old one is kept until then."""
        self._memory.make_room_for_map(voxel_map)
        try:
            self._matcher.set_map(voxel_map)
            self._tracking.map_changed(voxel_map)
        finally:
            self._memory.give_back()

    def _take_new_map(self) -> None:
        """Swap in the map that was built in the background, if any."""
        taken = self._map.take()
        if taken is not None:
            voxel_map, points = taken
            built = f"{voxel_map.voxels} voxels, built in {self._map.duration_ms:.0f} ms"
            self.get_logger().info(f"matching to a map of {built}")
            if points is not None:
                self._loaded_map.publish(points)

    def _aligned_to(self, scan: Points, T_map_guess: Matrix) -> Alignment:
        """Align from one of many guesses; only the pose is needed."""
        self._memory.make_room_for_scan(len(scan))
        return self._matcher.align_once(scan, T_map_guess, only_pose=True, is_wide=True)

    def _on_timer(self) -> None:
        if self._is_activated:
            self._map.look_after_loader()
        if not self._p.publish_loaded_map:
            self._loaded_map.look()
        self._thread.post(self._update_map)

    def _update_map(self) -> None:
        if self._p.publish_loaded_map:
            self._loaded_map.retry()
        report = self._diagnostics["map_update_status"]
        report.clear()
        now = self.get_clock().now().to_msg()
        report.value("timer_callback_time_stamp", seconds(now))
        report.value("is_activated", self._is_activated)
        if not self._is_activated:
            report.note("Node is not activated: call trigger_node_srv")
        self._take_new_map()
        self._map.report(report)
        report.publish(now)

    def _on_trigger(self, request: Any, response: Any) -> Any:
        report = self._diagnostics["trigger_node_service_status"]
        report.clear()
        now = self.get_clock().now().to_msg()
        report.value("service_call_time_stamp", seconds(now))
        self._is_activated = bool(request.data)
        self._thread.post(partial(self._tracking.activated, self._is_activated))
        self._thread.wake()
        if self._is_activated:
            self._poses.guesses.clear()
        response.success = True
        report.value("is_activated", self._is_activated)
        report.value("is_succeed_service", True)
        report.publish(now)
        return response


def main() -> None:
    """Run the node until interrupted."""
    run_node(NdtScanMatcher)


if __name__ == "__main__":
    main()
