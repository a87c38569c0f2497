# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""A behaviour tree that writes messages of /chatter to its blackboard."""

import py_trees
import py_trees_ros
import rclpy
from rclpy.executors import ExternalShutdownException
from rclpy.qos import QoSProfile
from std_msgs.msg import String


def main() -> None:
    """Tick the tree twice a second until interrupted."""
    rclpy.init()
    root = py_trees.composites.Sequence("listen", memory=False)
    root.add_child(
        py_trees_ros.subscribers.ToBlackboard(
            name="hear",
            topic_name="/chatter",
            topic_type=String,
            qos_profile=QoSProfile(depth=10),
            blackboard_variables={"heard": "data"},
        )
    )
    root.add_child(py_trees.behaviours.Success("done"))
    tree = py_trees_ros.trees.BehaviourTree(root=root)
    tree.setup(timeout=15.0)
    tree.tick_tock(period_ms=500.0)
    try:
        rclpy.spin(tree.node)
    except (KeyboardInterrupt, ExternalShutdownException):
        pass
    finally:
        tree.shutdown()
        rclpy.try_shutdown()


main()
