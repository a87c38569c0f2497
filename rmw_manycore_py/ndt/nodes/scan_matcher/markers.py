# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""Arrow markers for RViz: `ndt_marker` and `monte_carlo_initial_pose_marker`."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import numpy as np
from rclpy.node import Node
from std_msgs.msg import ColorRGBA
from visualization_msgs.msg import Marker, MarkerArray

from rmw_manycore_py.ndt.geometry.arrays import Matrix, Poses
from rmw_manycore_py.ndt.matching.initial_pose import Particle
from rmw_manycore_py.ndt.messages.conversions import pose_of
from rmw_manycore_py.ndt.nodes.scan_matcher.colors import colors
from rmw_manycore_py.ndt.nodes.scan_matcher.detail_publisher import DetailPublisher

ARROW_M = (0.5, 0.1, 0.1)  # length, width, height
STEPS_TO_RED = 15.0  # as in Autoware


class PoseMarkers:
    """Publishes only while there are subscriptions."""

    def __init__(self, node: Node, map_frame: str) -> None:
        self._map_frame = map_frame
        self._alignment = DetailPublisher(node, MarkerArray, "ndt_marker", 10)
        self._particles = DetailPublisher(node, MarkerArray, "monte_carlo_initial_pose_marker", 10)

    def alignment(self, stamp: Any, path: Poses) -> None:
        """Publish the guess of a scan and the pose after each step, from blue to red."""
        shares = colors(np.arange(1, len(path) + 1) / STEPS_TO_RED)
        arrows = [
            (T, ColorRGBA(r=red, g=green, b=blue, a=1.0))
            for T, (red, green, blue) in zip(path, shares, strict=True)
        ]
        self._publish(self._alignment, stamp, arrows)

    def particles(self, stamp: Any, tried: Sequence[Particle]) -> None:
        """Publish all results of a search, the worse the redder."""
        best = max((particle.score for particle in tried), default=0.0)
        arrows = []
        for particle in tried:
            share = max(particle.score, 0.0) / best if best > 0.0 else 0.0
            color = ColorRGBA(r=1.0 - share, g=share, b=0.0, a=1.0)
            arrows.append((particle.alignment.T_map_sensor, color))
        self._publish(self._particles, stamp, arrows)

    def _publish(
        self, publisher: DetailPublisher, stamp: Any, arrows: Sequence[tuple[Matrix, Any]]
    ) -> None:
        if not publisher.is_wanted:
            return
        # Delete the markers of earlier alignments, which may have had more steps.
        markers = [Marker(action=Marker.DELETEALL)]
        for index, (T, color) in enumerate(arrows):
            marker = Marker(ns="pose", id=index, type=Marker.ARROW, pose=pose_of(T), color=color)
            marker.scale.x, marker.scale.y, marker.scale.z = ARROW_M
            markers.append(marker)
        for marker in markers:
            marker.header.stamp, marker.header.frame_id = stamp, self._map_frame
        publisher.publish(MarkerArray(markers=markers))
