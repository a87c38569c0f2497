# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""Converts a PointCloud2 to points to match: in the base frame, validated, limited in number."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np

from rmw_manycore_py.ndt.geometry import poses
from rmw_manycore_py.ndt.geometry.arrays import Matrix, Points
from rmw_manycore_py.ndt.messages.conversions import seconds
from rmw_manycore_py.ndt.messages.point_cloud import CloudError, decode
from rmw_manycore_py.ndt.messages.point_times import FIELDS, TimesError, decode_timed, time_field
from rmw_manycore_py.ndt.nodes.scan_matcher.diagnostics import Diagnostics
from rmw_manycore_py.ndt.nodes.scan_matcher.frame_tree import FrameError, FrameTree
from rmw_manycore_py.ndt.nodes.scan_matcher.parameters import MatcherParameters, OwnParameters
from rmw_manycore_py.ndt.nodes.scan_matcher.rejected import Rejected


@dataclass(frozen=True)
class Scan:
    """Points (N, 3) of a scan in the base frame.

    :param times_s: (N) after the scan's stamp; None if not needed or missing.
    """

    points: Points
    times_s: Matrix | None = None


class ScanPoints:
    """Converts scans."""

    def __init__(
        self, parameters: MatcherParameters, own: OwnParameters, frames: FrameTree
    ) -> None:
        self._p = parameters
        self._own = own
        self._frames = frames
        self._max_points = own.scan_limit
        if own.behaviour != "autoware":
            self._max_points = min(own.max_matched, own.scan_limit)

    def of(self, message: Any, now_s: float, report: Diagnostics) -> Scan:
        """Return a scan in the base frame, with times if it is to be deskewed.

        :param now_s: time of the node's clock.
        :raises Rejected: if the scan is unusable.
        """
        report.value("sensor_points_size", message.width * message.height)
        try:
            points, times_s = self._decoded(message, report)
        except CloudError as error:
            raise Rejected(str(error)) from error
        if len(points) == 0:
            raise Rejected("Sensor points is empty: it has no point that is finite")
        self._report_delay(now_s - seconds(message.header.stamp), report)
        self._report_limit(message.width * message.height, report)
        points = self._in_base(points, message.header.frame_id, report)
        report.value("sensor_points_matched", len(points))
        farthest_m = float(np.sqrt(np.square(points, dtype=np.float64).sum(axis=1).max()))
        report.value("sensor_points_max_distance", round(farthest_m, 3))
        if farthest_m < self._p.required_distance_m:
            raise Rejected(
                f"Max distance of sensor points = {farthest_m:.3f} m < "
                f"{self._p.required_distance_m} m (sensor_points.required_distance)"
            )
        return Scan(np.ascontiguousarray(points, np.float32), times_s)

    def _decoded(self, message: Any, report: Diagnostics) -> tuple[Points, Matrix | None]:
        if not self._own.deskew:
            return decode(message, self._max_points), None
        field = time_field(message)
        if field is None:
            report.warn(f"not deskewed: the cloud has none of the fields {', '.join(FIELDS)}")
            return decode(message, self._max_points), None
        points, times_s = decode_timed(message, field, self._max_points)
        if isinstance(times_s, TimesError):
            report.warn(f"not deskewed: {times_s}")
            return points, None
        return points, times_s

    def _report_delay(self, delay_s: float, report: Diagnostics) -> None:
        report.value("sensor_points_delay_time_sec", round(delay_s, 4))
        if delay_s > self._p.timeout_s:
            report.warn(f"sensor points are {delay_s:.2f} s old (tolerance {self._p.timeout_s} s)")
        elif delay_s < -self._p.timeout_s:
            report.warn(f"sensor points are {-delay_s:.2f} s in the future: check the clocks")

    def _report_limit(self, count: int, report: Diagnostics) -> None:
        if count > self._own.scan_limit:
            report.warn(
                f"{count} points are more than sensor_points.limit ({self._own.scan_limit}): "
                f"{self._max_points} are used; add a voxel_grid_filter before the matcher"
            )

    def _in_base(self, points: Points, frame: str, report: Diagnostics) -> Points:
        if frame == self._p.base_frame:
            report.value("is_succeed_transform_sensor_points", True)
            return points
        try:
            T_base_sensor = self._frames.lookup(self._p.base_frame, frame)
        except FrameError as error:
            report.value("is_succeed_transform_sensor_points", False)
            what = f"publish TF {frame} to {self._p.base_frame}" if frame else "set its frame_id"
            raise Rejected(f"{error}. Please {what}") from error
        report.value("is_succeed_transform_sensor_points", True)
        return poses.transform(T_base_sensor, points)
