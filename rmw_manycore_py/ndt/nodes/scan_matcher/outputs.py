# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""Outputs of `ndt_scan_matcher` for a scan."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from typing import Any

import numpy as np
from autoware_internal_debug_msgs.msg import Float32Stamped, Int32Stamped
from geometry_msgs.msg import PoseArray, PoseStamped, PoseWithCovarianceStamped
from numpy.typing import NDArray
from rclpy.node import Node
from sensor_msgs.msg import PointCloud2
from tf2_msgs.msg import TFMessage

from rmw_manycore_py.ndt.geometry import poses
from rmw_manycore_py.ndt.geometry.arrays import Matrix, Points
from rmw_manycore_py.ndt.matching.alignment import Alignment
from rmw_manycore_py.ndt.messages.conversions import (
    pose_of,
    pose_stamped,
    pose_with_covariance,
    transform_stamped,
)
from rmw_manycore_py.ndt.messages.point_cloud import encode
from rmw_manycore_py.ndt.nodes.scan_matcher.colors import packed_colors
from rmw_manycore_py.ndt.nodes.scan_matcher.detail_publisher import DetailPublisher
from rmw_manycore_py.ndt.nodes.scan_matcher.pose_buffer import Interpolated

FLOATS = (
    "exe_time_ms",
    "transform_probability",
    "nearest_voxel_transformation_likelihood",
    "no_ground_transform_probability",
    "no_ground_nearest_voxel_transformation_likelihood",
    "initial_to_result_distance",
    "initial_to_result_distance_old",
    "initial_to_result_distance_new",
)
POSE_ARRAYS = ("multi_ndt_pose", "multi_initial_pose")
CLOUDS = ("points_aligned", "points_aligned_no_ground")
WORST_SCORE, BEST_SCORE = 1.0, 3.5  # point scores shown blue and red, as in Autoware


class MatcherOutputs:
    """Publishers, with Autoware's topic names."""

    def __init__(self, node: Node, map_frame: str, ndt_base_frame: str) -> None:
        self._map_frame = map_frame
        self._ndt_base_frame = ndt_base_frame
        self._pose = node.create_publisher(PoseStamped, "ndt_pose", 10)
        self._with_covariance = node.create_publisher(
            PoseWithCovarianceStamped, "ndt_pose_with_covariance", 10
        )
        self._initial = node.create_publisher(
            PoseWithCovarianceStamped, "initial_pose_with_covariance", 10
        )
        self._relative = node.create_publisher(PoseStamped, "initial_to_result_relative_pose", 10)
        self._tf = node.create_publisher(TFMessage, "/tf", 100)
        self._iterations = node.create_publisher(Int32Stamped, "iteration_num", 10)
        self._floats = {name: node.create_publisher(Float32Stamped, name, 10) for name in FLOATS}
        self._pose_arrays = {n: DetailPublisher(node, PoseArray, n, 10) for n in POSE_ARRAYS}
        self._clouds = {name: DetailPublisher(node, PointCloud2, name, 10) for name in CLOUDS}
        self._scored = DetailPublisher(node, PointCloud2, "voxel_score_points", 10)

    def accepted_pose(self, stamp: Any, T_map_base: Matrix, covariance: Matrix) -> None:
        """Publish a reliable pose."""
        self._pose.publish(pose_stamped(T_map_base, stamp, self._map_frame))
        self._with_covariance.publish(
            pose_with_covariance(T_map_base, covariance, stamp, self._map_frame)
        )

    def result(self, stamp: Any, alignment: Alignment, guess: Interpolated) -> None:
        """Publish the details of an alignment, accepted or not."""
        T = alignment.T_map_sensor
        transform = transform_stamped(T, stamp, self._map_frame, self._ndt_base_frame)
        self._tf.publish(TFMessage(transforms=[transform]))
        self._initial.publish(
            pose_with_covariance(guess.T, np.zeros((6, 6)), stamp, self._map_frame)
        )
        self._relative.publish(pose_stamped(poses.inverse(guess.T) @ T, stamp, self._map_frame))
        self._iterations.publish(Int32Stamped(stamp=stamp, data=alignment.iterations))
        self.number("transform_probability", stamp, alignment.transform_probability)
        self.number(
            "nearest_voxel_transformation_likelihood", stamp, alignment.nearest_voxel_likelihood
        )
        self.number("initial_to_result_distance", stamp, poses.distance_m(guess.T, T))
        self.number("initial_to_result_distance_old", stamp, poses.distance_m(guess.old.T, T))
        self.number("initial_to_result_distance_new", stamp, poses.distance_m(guess.new.T, T))

        self._several("multi_initial_pose", stamp, alignment.guesses_around)
        self._several("multi_ndt_pose", stamp, alignment.results_around)

    def number(self, name: str, stamp: Any, value: float) -> None:
        """Publish one of FLOATS."""
        self._floats[name].publish(Float32Stamped(stamp=stamp, data=float(value)))

    def cloud(self, name: str, stamp: Any, points_base: Points, T_map_base: Matrix) -> None:
        """Publish one of CLOUDS in the map frame, if there are subscriptions."""
        if self._clouds[name].is_wanted:
            points = poses.transform(T_map_base, points_base.astype(np.float64))
            self._clouds[name].publish(encode(points, stamp, self._map_frame))

    def scored_cloud(
        self,
        stamp: Any,
        points_base: Points,
        T_map_base: Matrix,
        scores_of: Callable[[Points, Matrix], NDArray[np.float32]],
    ) -> None:
        """Publish points with voxels nearby, coloured by score, if there are subscriptions."""
        if not self._scored.is_wanted:
            return
        scores = scores_of(points_base, T_map_base)
        seen = np.isfinite(scores)
        points = poses.transform(T_map_base, points_base[seen].astype(np.float64))
        share = (scores[seen] - WORST_SCORE) / (BEST_SCORE - WORST_SCORE)
        rgb = packed_colors(share)
        self._scored.publish(encode(points, stamp, self._map_frame, {"rgb": rgb}))

    def _several(self, name: str, stamp: Any, several: Sequence[Matrix]) -> None:
        """Publish one of POSE_ARRAYS, if there are poses and subscriptions."""
        if several and self._pose_arrays[name].is_wanted:
            message = PoseArray(poses=[pose_of(T) for T in several])
            message.header.stamp, message.header.frame_id = stamp, self._map_frame
            self._pose_arrays[name].publish(message)
