# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""Plays a recording to a scan matcher: sends guesses and scans on time, receives poses."""

from __future__ import annotations

import time
from collections.abc import Callable, Collection
from typing import Any

import numpy as np
from builtin_interfaces.msg import Time
from diagnostic_msgs.msg import DiagnosticArray
from geometry_msgs.msg import PoseStamped, PoseWithCovarianceStamped
from rclpy.node import Node
from rclpy.qos import DurabilityPolicy, QoSProfile
from sensor_msgs.msg import PointCloud2

from rmw_manycore_py.errors import ManycoreError
from rmw_manycore_py.ndt.geometry.arrays import Points
from rmw_manycore_py.ndt.geometry.thinning import voxel_centroids
from rmw_manycore_py.ndt.messages.conversions import covariance_of, matrix_of, nanoseconds, stamp_of
from rmw_manycore_py.ndt.messages.point_cloud import encode
from rmw_manycore_py.ndt.recordings.recording import Recording
from rmw_manycore_py.ndt.replay.guess_source import MAP_FRAME, GuessSource
from rmw_manycore_py.ndt.replay.tally import Played, Tally
from rmw_manycore_py.process.cpu_time import tree_cpu_s
from rmw_manycore_py.process.spinning import spin_once

BASE_FRAME = "base_link"
WARM_UP_PERIOD_S = 0.25
# Before the first scan. A matcher remembers guesses for a second: those of the warm-up stand still,
# which is not how the drive begins.
LEAD_S = 1.1
# Topics may overtake each other; a filter's prediction precedes the scan, which a LiDAR takes 0.1 s
# to record.
GUESS_LEAD_S = 0.005
FOLLOW_UP_S = 1.0  # minimum wait for answers after the last scan


class Player(Node):
    """Publishes map and scans like a laptop, and measures the answers."""

    def __init__(
        self,
        drive: Recording,
        source: GuessSource,
        tally: Tally,
        voxel_m: float,
        pid: int | None = None,
    ) -> None:
        """Connect; CPU time is measured of a process, or taken from the matcher's diagnostics."""
        super().__init__("ndt_replay")
        self._drive = drive
        self._source = source
        self._tally = tally
        self._voxel_m = voxel_m
        self._pid = pid
        self._waiting: dict[int, Played] = {}  # by stamp [ns]; not answered yet
        self._played: dict[int, Played] = {}  # by stamp [ns]
        self._warm_stamps: set[int] = set()
        self._is_warm = False
        self._times_s = drive.times_s()  # play time of each scan after the first
        self._pace = 1.0  # duration when played, relative to the recording
        kept = QoSProfile(depth=1, durability=DurabilityPolicy.TRANSIENT_LOCAL)
        self._map = self.create_publisher(PointCloud2, "pointcloud_map", kept)
        self._source.advertise(self)
        self._scans = self.create_publisher(PointCloud2, "points_raw", 5)
        self.create_subscription(PoseStamped, "ndt_pose", self._on_pose, 100)
        self.create_subscription(
            PoseWithCovarianceStamped, "ndt_pose_with_covariance", self._on_covariance, 100
        )
        self.create_subscription(DiagnosticArray, "/diagnostics", self._on_diagnostics, 100)

    def publish_map(self, points: Points) -> None:
        """Publish the map, transient local."""
        self._map.publish(encode(points, Time(), MAP_FRAME))

    def warm_up(self, timeout_s: float) -> None:
        """Repeat the first scan until it is answered: then all are connected and there is a map."""
        scan = self._scan(0)
        deadline = time.monotonic() + timeout_s
        while not self._is_warm:
            if time.monotonic() > deadline:
                raise ManycoreError(self._why_cold(timeout_s))
            stamp_ns = time.time_ns()
            self._warm_stamps.add(stamp_ns)
            self._source.send_first(stamp_ns)
            self._send(stamp_ns, scan)
            self._spin_until(time.monotonic() + WARM_UP_PERIOD_S, lambda: self._is_warm)

    def play(self, rate_hz: float | None, waits: bool, report: Callable[[Played], None]) -> None:
        """Play all scans, by their stamps or at a rate; call `report` after each.

        With `waits`, play each scan after the previous answer. Stamps keep the recording's
        intervals in any case: a matcher checks whether the speed is plausible. At another rate
        the points' times are scaled as the stamps are, else deskewing would see another speed.
        """
        if rate_hz is not None:
            periods_s = np.diff(self._times_s)
            self._pace = 1.0 / (rate_hz * float(np.median(periods_s))) if len(periods_s) else 1.0
            self._times_s = np.arange(len(self._drive)) / rate_hz
        if not waits and len(self._times_s) > 1:
            self._tally.wanted_hz = (len(self._times_s) - 1) / float(self._times_s[-1])
        start, start_ns = time.monotonic() + LEAD_S, time.time_ns() + round(1e9 * LEAD_S)
        self._source.lead_in(start_ns)
        for index, time_s in enumerate(self._times_s):
            scan = self._scan(index)
            self._spin_until(start + float(time_s))
            stamp_ns = start_ns + round(1e9 * float(time_s))
            guess = self._source.send(index, float(time_s), stamp_ns)
            self._spin_until(time.monotonic() + GUESS_LEAD_S)
            recorded_s = self._drive.stamp_s(index)
            row = Played(index, recorded_s, self._drive.poses[index], guess, time.monotonic())
            self._tally.rows.append(row)
            self._waiting[stamp_ns] = self._played[stamp_ns] = row
            self._note_cpu_time()
            self._send(stamp_ns, scan)
            report(row)
            if waits:
                self._wait_for([stamp_ns])
        self._wait_for(list(self._waiting))
        self._wait_for_reports()
        self._note_cpu_time()

    def _wait_for(self, stamps_ns: Collection[int]) -> None:
        """Handle messages until these scans are answered or late."""
        end = time.monotonic() + max(FOLLOW_UP_S, self._tally.deadline_ms / 1e3)
        self._spin_until(end, lambda: self._waiting.keys().isdisjoint(stamps_ns))

    def _wait_for_reports(self) -> None:
        """Handle diagnostics that follow their pose; return at once if there are none."""
        rows = self._tally.rows
        if any(row.report for row in rows):
            end = time.monotonic() + FOLLOW_UP_S
            self._spin_until(end, lambda: all(row.report for row in rows))

    def _note_cpu_time(self) -> None:
        if self._pid is not None:
            self._tally.cpu_s.append((time.monotonic(), tree_cpu_s(self._pid)))

    def _scan(self, index: int) -> Any:
        points, times_s = self._drive.scan(index), self._drive.point_times_s(index)
        columns = points if times_s is None else np.column_stack([points, self._pace * times_s])
        if self._voxel_m > 0.0:
            columns = voxel_centroids(columns, (self._voxel_m,) * 3)
        more = {} if times_s is None else {"time": columns[:, 3]}
        return encode(columns[:, :3], Time(), BASE_FRAME, more)

    def _send(self, stamp_ns: int, scan: Any) -> None:
        scan.header.stamp = stamp_of(stamp_ns)
        self._scans.publish(scan)

    def _on_pose(self, message: Any) -> None:
        stamp_ns = nanoseconds(message.header.stamp)
        if stamp_ns in self._warm_stamps:
            self._is_warm = True
        row = self._waiting.pop(stamp_ns, None)
        if row is None:
            return
        row.latency_ms = 1e3 * (time.monotonic() - row.sent_s)
        row.result = matrix_of(message.pose)
        time_s = float(self._times_s[row.index])
        self._source.result(row.index, time_s, row.result)

    def _on_covariance(self, message: Any) -> None:
        row = self._played.get(nanoseconds(message.header.stamp))
        if row is not None:
            row.covariance = covariance_of(message)

    def _on_diagnostics(self, message: Any) -> None:
        row = self._played.get(nanoseconds(message.header.stamp))
        for status in message.status:
            values = {pair.key: pair.value for pair in status.values}
            if row is not None and status.name.endswith("scan_matching_status"):
                row.reason, row.report = status.message, values
            if self._pid is None and "cpu_time_s" in values and self._tally.rows:
                self._tally.cpu_s.append((time.monotonic(), float(values["cpu_time_s"])))

    def _spin_until(self, deadline: float, done: Callable[[], bool] = lambda: False) -> None:
        """Handle messages until a deadline or a condition."""
        while not done() and (left_s := deadline - time.monotonic()) > 0.0:
            spin_once(self, left_s)

    def _why_cold(self, timeout_s: float) -> str:
        if self._scans.get_subscription_count() == 0:
            return (
                "points_raw has no subscription: start a scan matcher first, for example "
                "`manycore run ndt_offload`, in the same ROS_DOMAIN_ID"
            )
        return (
            f"no ndt_pose within {timeout_s:g} s, though points_raw has a subscriber: its "
            "/diagnostics and its log say why (no map, not activated, a score below its threshold)"
        )
