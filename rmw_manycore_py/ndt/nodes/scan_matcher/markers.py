# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""Poses as arrows for RViz: `ndt_marker` and `monte_carlo_initial_pose_marker`."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

from rclpy.node import Node
from std_msgs.msg import ColorRGBA
from visualization_msgs.msg import Marker, MarkerArray

from rmw_manycore_py.ndt.geometry.arrays import Matrix
from rmw_manycore_py.ndt.matching.initial_pose import Particle
from rmw_manycore_py.ndt.messages.conversions import pose_of

ARROW_M = (0.5, 0.1, 0.1)  # length, width, height
GUESS, RESULT = ColorRGBA(r=0.5, g=0.5, b=0.5, a=1.0), ColorRGBA(r=0.0, g=0.8, b=0.2, a=1.0)


class PoseMarkers:
    """Publishes only while somebody subscribes."""

    def __init__(self, node: Node, map_frame: str) -> None:
        self._map_frame = map_frame
        self._alignment = node.create_publisher(MarkerArray, "ndt_marker", 10)
        self._particles = node.create_publisher(MarkerArray, "monte_carlo_initial_pose_marker", 10)

    def alignment(self, stamp: Any, T_guess: Matrix, T_result: Matrix) -> None:
        """Show guess and result of a scan."""
        self._publish(self._alignment, stamp, [(T_guess, GUESS), (T_result, RESULT)])

    def particles(self, stamp: Any, tried: Sequence[Particle]) -> None:
        """Show all results of a search, the redder the worse."""
        best = max((particle.score for particle in tried), default=0.0)
        arrows = []
        for particle in tried:
            share = max(particle.score, 0.0) / best if best > 0.0 else 0.0
            color = ColorRGBA(r=1.0 - share, g=share, b=0.0, a=1.0)
            arrows.append((particle.alignment.T_map_sensor, color))
        self._publish(self._particles, stamp, arrows)

    def _publish(self, publisher: Any, stamp: Any, arrows: Sequence[tuple[Matrix, Any]]) -> None:
        if publisher.get_subscription_count() == 0:
            return
        message = MarkerArray()
        for index, (T, color) in enumerate(arrows):
            marker = Marker(ns="pose", id=index, type=Marker.ARROW, pose=pose_of(T), color=color)
            marker.header.stamp, marker.header.frame_id = stamp, self._map_frame
            marker.scale.x, marker.scale.y, marker.scale.z = ARROW_M
            message.markers.append(marker)
        publisher.publish(message)
