# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""`lidar_localizer`: the pose of each scan, by passes that other clusters compute."""

from __future__ import annotations

import threading
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np
from autoware_msgs.msg import NDTStat
from geometry_msgs.msg import PoseStamped, PoseWithCovarianceStamped, TwistStamped
from manycore_ros_lite_msgs.msg import Pool, Query, Sums
from numpy.typing import NDArray
from rclpy._rclpy_pybind11 import RCLError
from rclpy.node import Node
from sensor_msgs.msg import PointCloud2
from std_msgs.msg import Header

from rmw_manycore_py.errors import ManycoreError
from rmw_manycore_py.ndt.geometry.arrays import Matrix, map_points
from rmw_manycore_py.ndt.geometry.poses import to_rpy
from rmw_manycore_py.ndt.maps.map_file import read_points
from rmw_manycore_py.ndt.messages.conversions import (
    PoseError,
    matrix_of,
    nanoseconds,
    pose_of,
    stamp_of,
)
from rmw_manycore_py.ndt.messages.point_cloud import CloudError, decode
from rmw_manycore_py.ndt.nodes.support.declared import declare, parameter
from rmw_manycore_py.ndt.nodes.support.log_throttle import ThrottledLog
from rmw_manycore_py.ndt.nodes.support.running import run_node
from rmw_manycore_py.papers.roslite.localization.alignment import (
    Prediction,
    SumsAt,
    aligned,
    pairs_in,
    sums_of,
)
from rmw_manycore_py.papers.roslite.localization.options import OPTIONS, TILE_M
from rmw_manycore_py.papers.roslite.localization.remote_pass import (
    Part,
    PassesEndedError,
    RemotePass,
)
from rmw_manycore_py.papers.roslite.localization.tiles import tiles_of
from rmw_manycore_py.papers.roslite.messages import LATCHED
from rmw_manycore_py.process.steady import steady_s

FRAME = "map"


@dataclass(frozen=True)
class LocalizerParameters:
    """Parameters of the node; without derivatives it computes all alone."""

    map_path: str = parameter("map", "map.npz")
    derivatives: int = parameter("derivatives", 5, min_value=0)
    timeout_s: float = parameter("pass_timeout", 1.0, above=0.0)


class LidarLocalizer(Node):
    """Publishes `current_pose`, `current_velocity` and `ndt_stat` for each scan.

    A thread aligns while the executor takes in what the derivatives answer. A scan that comes
    during an alignment replaces the one that waits.
    """

    def __init__(self) -> None:
        # At shutdown, newer releases of rclpy destroy nodes whose construction is under way.
        self._woken = threading.Condition()
        self._ends = False
        self._thread = threading.Thread(target=self._align_all, name="alignment")
        super().__init__("lidar_localizer")
        self._p = declare(self, LocalizerParameters)
        self._complain = ThrottledLog(self.get_logger().warning)
        self._tiles = tiles_of(map_points(read_points(Path(self._p.map_path))), TILE_M, OPTIONS)
        self._remote = RemotePass(self._ask, self._p.derivatives, self._p.timeout_s)
        self._prediction: Prediction | None = None
        self._scan: Any = None
        self._advertise()
        self._subscribe()
        self._thread.start()

    def destroy_node(self) -> None:
        """End the thread, too."""
        with self._woken:
            self._ends = True
            self._woken.notify()
        if self._thread.is_alive():
            self._remote.close()
            self._thread.join()
        super().destroy_node()

    def _advertise(self) -> None:
        self._poses = self.create_publisher(PoseStamped, "current_pose", 1)
        self._velocities = self.create_publisher(TwistStamped, "current_velocity", 1)
        self._stats = self.create_publisher(NDTStat, "ndt_stat", 10)
        self._queries = self.create_publisher(Query, "ndt_query", 1)
        self._pool = self.create_publisher(Pool, "ndt_pool", LATCHED)
        self._pool.publish(
            Pool(
                tile_m=TILE_M,
                outlier_ratio=OPTIONS.outlier_ratio,
                voxel_size_m=OPTIONS.voxel_size_m,
                columns=[key.column for key in self._tiles],
                rows=[key.row for key in self._tiles],
                sizes=[tile.size_bytes for tile in self._tiles.values()],
                paths=[tile.shared_path for tile in self._tiles.values()],
            )
        )

    def _subscribe(self) -> None:
        self.create_subscription(
            PoseWithCovarianceStamped, "initialpose", self._on_initial_pose, LATCHED
        )
        self.create_subscription(PointCloud2, "filtered_points", self._on_scan, 1)
        if self._p.derivatives:  # a late pass is noticed within a quarter of its timeout
            self.create_timer(self._p.timeout_s / 4, self._remote.look)
        self.create_subscription(Sums, "ndt_sums", self._on_sums, 10 * max(self._p.derivatives, 1))

    def _on_initial_pose(self, message: Any) -> None:
        try:
            pose = matrix_of(message.pose.pose)
        except PoseError as error:
            self._complain(f"initialpose ignored: {error}")
            return
        with self._woken:
            self._prediction = Prediction(pose, 1e-9 * nanoseconds(message.header.stamp))

    def _on_scan(self, message: Any) -> None:
        with self._woken:
            self._scan = message
            self._woken.notify()

    def _on_sums(self, message: Any) -> None:
        stamp_ns = nanoseconds(message.stamp)
        sums = np.asarray(message.sums)
        self._remote.arrived(Part(stamp_ns, message.pass_number, message.part, sums))

    def _ask(self, scan_ns: int, number: int, pose: Matrix) -> None:
        self._queries.publish(Query(stamp=stamp_of(scan_ns), pass_number=number, pose=pose.ravel()))

    def _align_all(self) -> None:
        while True:
            with self._woken:
                self._woken.wait_for(lambda: self._ends or self._scan is not None)
                if self._ends:
                    return
                message, self._scan = self._scan, None
                prediction = self._prediction
            if prediction is None:
                self._complain("waiting for initialpose: no pose is published")
                continue
            try:
                self._align(decode(message).astype(np.float32), message.header, prediction)
            except (CloudError, ManycoreError) as error:
                self._complain(f"filtered_points: {error}")
            except PassesEndedError:
                return
            except RCLError:
                if self.context.ok():
                    raise
                return  # ended by a signal while a scan was aligned

    def _align(self, scan: NDArray[np.float32], header: Any, prediction: Prediction) -> None:
        begin_s = steady_s()
        scan_ns = nanoseconds(header.stamp)
        self._remote.begin(scan_ns)
        before, before_s = prediction.pose, prediction.stamp_s
        compute = self._remote if self._p.derivatives else self._alone(scan)
        passes = 0

        def counted(pose: Matrix) -> NDArray[np.float64]:
            nonlocal passes
            passes += 1
            return compute(pose)

        found = aligned(prediction.guess(1e-9 * scan_ns), counted, OPTIONS)
        if found.outcome != "converged":
            self._complain(f"filtered_points: no pose, as it ended with {found.outcome}")
            return
        prediction.update(found.pose, 1e-9 * scan_ns)
        self._publish(found.pose, header.stamp)
        self._publish_velocity(before, found.pose, prediction.stamp_s - before_s, header.stamp)
        stat = NDTStat(iteration=passes)
        stat.header.stamp = header.stamp
        stat.exe_time = 1e3 * (steady_s() - begin_s)
        stat.score = found.at.score
        self._stats.publish(stat)

    def _alone(self, scan: NDArray[np.float32]) -> SumsAt:
        return lambda pose: sums_of(pairs_in(self._tiles, scan, pose, TILE_M), OPTIONS)

    def _publish(self, T_map_sensor: Matrix, stamp: Any) -> None:
        message = PoseStamped(header=Header(stamp=stamp, frame_id=FRAME))
        message.pose = pose_of(T_map_sensor)
        self._poses.publish(message)

    def _publish_velocity(self, before: Matrix, pose: Matrix, took_s: float, stamp: Any) -> None:
        if took_s <= 0.0:
            return
        message = TwistStamped(header=Header(stamp=stamp, frame_id="base_link"))
        motion = np.linalg.inv(before) @ pose
        message.twist.linear.x = float(motion[0, 3]) / took_s
        message.twist.angular.z = float(to_rpy(motion)[2]) / took_s
        self._velocities.publish(message)


def main() -> None:
    """Run the node until interrupted."""
    run_node(LidarLocalizer)


if __name__ == "__main__":
    main()
