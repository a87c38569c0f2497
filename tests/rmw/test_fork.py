# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""fork() in a process with nodes: the child starts afresh, the parent is not affected."""

from __future__ import annotations

import multiprocessing
import os
from collections.abc import Callable
from concurrent.futures import ProcessPoolExecutor
from typing import Any

import pytest
import rclpy
from rclpy._rclpy_pybind11 import RCLError
from rclpy.executors import SingleThreadedExecutor
from std_msgs.msg import String
from std_srvs.srv import Trigger

from support import IS_MANYCORE, TIMEOUT_S
from support.nodes.exchanging import status_of_child
from support.nodes.ros import spin_until

pytestmark = [
    # Python 3.12 and newer warn about what is tested here.
    pytest.mark.filterwarnings("ignore:.*multi-threaded, use of fork:DeprecationWarning"),
    pytest.mark.skipif(not IS_MANYCORE, reason="other middlewares say nothing about fork()"),
]


def say_from_a_context_of_its_own(text: str) -> None:
    """Publish in a new context until a subscription matches."""
    context = rclpy.Context()
    rclpy.init(context=context)
    node = rclpy.create_node("child", context=context)
    publisher = node.create_publisher(String, "chatter", 10)
    executor = SingleThreadedExecutor(context=context)
    executor.add_node(node)
    while publisher.get_subscription_count() == 0:
        executor.spin_once(timeout_sec=0.01)
    publisher.publish(String(data=text))
    publisher.wait_for_all_acked(rclpy.duration.Duration(seconds=TIMEOUT_S))
    node.destroy_node()
    rclpy.shutdown(context=context)


def refused(act: Callable[[], Any]) -> None:
    with pytest.raises(RCLError, match=r"cannot be used after fork\(\)"):
        act()


def test_inherited_handles_fail_with_the_cure(node):
    publisher = node.create_publisher(String, "chatter", 10)
    received: list[str] = []
    node.create_subscription(String, "chatter", lambda message: received.append(message.data), 10)
    client = node.create_client(Trigger, "trigger")

    def use_all() -> None:
        refused(lambda: publisher.publish(String(data="from the child")))
        refused(lambda: client.call_async(Trigger.Request()))
        refused(lambda: node.create_publisher(String, "another", 10))
        refused(lambda: rclpy.spin_once(node, timeout_sec=TIMEOUT_S))

    assert status_of_child(use_all) == 0
    publisher.publish(String(data="from the parent"))
    spin_until(node, lambda: received)
    assert received == ["from the parent"]


def test_a_child_that_ends_as_programs_do_takes_nothing_along(node):
    publisher = node.create_publisher(String, "chatter", 10)
    received: list[str] = []
    node.create_subscription(String, "chatter", lambda message: received.append(message.data), 10)

    def end() -> None:
        node.destroy_node()
        rclpy.shutdown()

    assert status_of_child(end) == 0
    publisher.publish(String(data="still here"))
    spin_until(node, lambda: received)
    assert node.get_node_names() == ["tester"]


def test_a_child_joins_as_a_process_of_its_own(node):
    received: list[str] = []
    node.create_subscription(String, "chatter", lambda message: received.append(message.data), 10)
    child = os.fork()
    if child == 0:
        say_from_a_context_of_its_own("from the child")
        os._exit(0)
    spin_until(node, lambda: received)
    assert os.waitstatus_to_exitcode(os.waitpid(child, 0)[1]) == 0
    assert received == ["from the child"]
    spin_until(node, lambda: node.get_node_names() == ["tester"])


@pytest.mark.parametrize("method", ["fork", "spawn", "forkserver"])
def test_multiprocessing(node, method):
    received: list[str] = []
    node.create_subscription(String, "chatter", lambda message: received.append(message.data), 10)
    context = multiprocessing.get_context(method)
    child = context.Process(target=say_from_a_context_of_its_own, args=[method])
    child.start()
    spin_until(node, lambda: received)
    child.join(TIMEOUT_S)
    assert child.exitcode == 0
    assert received == [method]


def test_workers_of_a_pool_leave_the_nodes_of_their_parent_alone(node):
    publisher = node.create_publisher(String, "chatter", 10)
    received: list[str] = []
    node.create_subscription(String, "chatter", lambda message: received.append(message.data), 10)
    with ProcessPoolExecutor(2, multiprocessing.get_context("fork")) as pool:
        assert list(pool.map(abs, range(-20, 0))) == list(range(20, 0, -1))
        publisher.publish(String(data="beside the pool"))
        spin_until(node, lambda: received)
    assert node.get_node_names() == ["tester"]


def test_a_child_does_not_share_the_platform_of_the_discovery_range_off(monkeypatch):
    monkeypatch.setenv("ROS_AUTOMATIC_DISCOVERY_RANGE", "OFF")
    rclpy.init()
    node = rclpy.create_node("parent")

    def look() -> None:
        context = rclpy.Context()
        rclpy.init(context=context)
        own = rclpy.create_node("child", context=context)
        assert own.get_node_names() == ["child"]
        own.destroy_node()
        rclpy.shutdown(context=context)

    assert status_of_child(look) == 0
    assert node.get_node_names() == ["parent"]
    node.destroy_node()
    rclpy.shutdown()
