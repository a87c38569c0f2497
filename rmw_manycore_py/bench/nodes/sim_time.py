# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""Nodes with `use_sim_time`, and the simulator that publishes /clock.

Usage: sim_time node NUMBER | sim_time clock NODES TIMES RATE_HZ

Both report ready, the clock when all nodes have found it. The clock starts, and a node ends, at the
end of its input. A node prints how many times its clock moved, the clock how long it ran.
"""

from __future__ import annotations

import json
import sys
import threading
import time

import rclpy
from rclpy.clock import JumpThreshold, TimeJump
from rclpy.duration import Duration
from rclpy.executors import SingleThreadedExecutor
from rclpy.parameter import Parameter
from rclpy.qos import QoSProfile, ReliabilityPolicy
from rosgraph_msgs.msg import Clock

_LOOK_S = 0.02
_ANY_MOVE = JumpThreshold(
    min_forward=Duration(nanoseconds=1), min_backward=None, on_clock_change=False
)


def _run_node(number: int) -> None:
    simulated = Parameter("use_sim_time", value=True)
    node = rclpy.create_node(f"simulated_{number}", parameter_overrides=[simulated])
    moves = 0

    def count(_: TimeJump) -> None:
        nonlocal moves
        moves += 1

    handle = node.get_clock().create_jump_callback(_ANY_MOVE, post_callback=count)
    executor = SingleThreadedExecutor()
    executor.add_node(node)
    spinner = threading.Thread(target=executor.spin)
    spinner.start()
    print("ready", flush=True)
    sys.stdin.read()
    executor.shutdown()
    spinner.join()
    handle.unregister()
    print(json.dumps({"moves": moves}))
    node.destroy_node()


def _run_clock(nodes: int, times: int, rate_hz: int) -> None:
    node = rclpy.create_node("simulator")
    qos = QoSProfile(depth=1, reliability=ReliabilityPolicy.BEST_EFFORT)
    publisher = node.create_publisher(Clock, "/clock", qos)
    while publisher.get_subscription_count() < nodes:
        time.sleep(_LOOK_S)
    print("ready", flush=True)
    sys.stdin.read()
    message = Clock()
    start_s = time.monotonic()
    for number in range(1, times + 1):
        time.sleep(max(start_s + number / rate_hz - time.monotonic(), 0))
        message.clock.sec, message.clock.nanosec = divmod(number * 10**9 // rate_hz, 10**9)
        publisher.publish(message)
    print(json.dumps({"seconds": time.monotonic() - start_s}))
    node.destroy_node()


def main() -> None:
    """Run the role."""
    role, *numbers = sys.argv[1:]
    rclpy.init()
    if role == "node":
        _run_node(int(numbers[0]))
    else:
        nodes, times, rate_hz = map(int, numbers)
        _run_clock(nodes, times, rate_hz)
    rclpy.shutdown()


if __name__ == "__main__":
    main()
