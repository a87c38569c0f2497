# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""`static_trajectory_publisher`: publishes a trajectory from a file."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path

from autoware_planning_msgs.msg import Trajectory as TrajectoryMessage
from rclpy.node import Node
from rclpy.qos import DurabilityPolicy, QoSProfile

from rmw_manycore_py.errors import EXIT_BAD_INPUT, ManycoreError
from rmw_manycore_py.ndt.nodes.support.declared import declare, parameter
from rmw_manycore_py.ndt.nodes.support.running import run_node
from rmw_manycore_py.papers.roslite2.course.trajectory_file import read_trajectory
from rmw_manycore_py.papers.roslite2.laws.wheelchair import MAX_SPEED_M_S
from rmw_manycore_py.papers.roslite2.messages import trajectory_message


@dataclass(frozen=True)
class PublisherParameters:
    """Own parameters; wheel base and maximum speed are those of the driving vehicle."""

    path: str = parameter("trajectory_path", "")
    period_s: float = parameter("publish_period", 1.0, above=0.0)
    map_frame: str = parameter("map_frame", "map")
    wheel_base_m: float = parameter("wheel_base", 0.45, above=0.0)
    max_speed_m_s: float = parameter("vehicle_velocity_limit", MAX_SPEED_M_S, above=0.0)


class StaticTrajectoryPublisher(Node):
    """Publishes `trajectory` periodically, since subscribers of planners are volatile."""

    def __init__(self) -> None:
        super().__init__("static_trajectory_publisher")
        self._p = declare(self, PublisherParameters)
        if not self._p.path:
            raise ManycoreError(
                "parameter trajectory_path: expected a file, found none", EXIT_BAD_INPUT
            )
        path = Path(self._p.path).expanduser()
        trajectory = read_trajectory(path, self._p.wheel_base_m, self._p.max_speed_m_s)
        self._message = trajectory_message(trajectory, self._p.map_frame)
        self._message.header.stamp = self.get_clock().now().to_msg()  # one trajectory, one stamp
        kept = QoSProfile(depth=1, durability=DurabilityPolicy.TRANSIENT_LOCAL)
        self._output = self.create_publisher(TrajectoryMessage, "trajectory", kept)
        self.get_logger().info(f"publishing {len(trajectory)} points")
        self._publish()
        self.create_timer(self._p.period_s, self._publish)

    def _publish(self) -> None:
        self._output.publish(self._message)


def main() -> None:
    """Run the node until interrupted."""
    run_node(StaticTrajectoryPublisher)


if __name__ == "__main__":
    main()
