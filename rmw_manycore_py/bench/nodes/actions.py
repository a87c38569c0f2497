# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""An action server, an active client, and idle clients.

Usage: actions server | actions idle CLIENTS | actions caller WARM_UP GOALS

Server and idle clients report ready when set up, and exit at the end of their input. The caller
prints the duration of each goal, from sending it to its result.
"""

from __future__ import annotations

import json
import sys
import threading
import time
from typing import Any

import rclpy
from rclpy.action import ActionClient, ActionServer
from rclpy.executors import SingleThreadedExecutor
from rclpy.node import Node
from tf2_msgs.action import LookupTransform

NAME = "look_up"


def _serve(node: Node) -> None:
    def execute(goal: Any) -> Any:
        goal.succeed()
        return LookupTransform.Result()

    node.action_server = ActionServer(node, LookupTransform, NAME, execute)


def _listen(node: Node, clients: int) -> None:
    node.action_clients = [ActionClient(node, LookupTransform, NAME) for _ in range(clients)]


def _call(node: Node, executor: SingleThreadedExecutor, goals: int) -> list[int]:
    client = ActionClient(node, LookupTransform, NAME)
    client.wait_for_server()
    samples_ns = []
    for _ in range(goals):
        start_ns = time.monotonic_ns()
        goal = client.send_goal_async(LookupTransform.Goal())
        executor.spin_until_future_complete(goal)
        result = goal.result().get_result_async()
        executor.spin_until_future_complete(result)
        samples_ns.append(time.monotonic_ns() - start_ns)
    return samples_ns


def main() -> None:
    """Run the role."""
    role, *numbers = sys.argv[1:]
    rclpy.init()
    node = rclpy.create_node(f"action_{role}")
    executor = SingleThreadedExecutor()
    executor.add_node(node)
    if role == "caller":
        warm_up, goals = map(int, numbers)
        samples_ns = _call(node, executor, warm_up + goals)
        print(json.dumps({"samples_ns": samples_ns[warm_up:]}))
    else:
        _serve(node) if role == "server" else _listen(node, *map(int, numbers))
        spinner = threading.Thread(target=executor.spin)
        spinner.start()
        print("ready", flush=True)
        sys.stdin.read()
        executor.shutdown()
        spinner.join()
    node.destroy_node()
    rclpy.shutdown()


if __name__ == "__main__":
    main()
