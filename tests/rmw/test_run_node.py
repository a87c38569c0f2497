# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""Nodes of the stacks end quietly wherever an interrupt meets them, and loudly by an error."""

from __future__ import annotations

import sys

import pytest

pytestmark = pytest.mark.rmw

NODE = """
import signal, time
import rclpy
from rclpy.node import Node
from std_msgs.msg import String
from rmw_manycore_py.ndt.nodes.support.running import run_node

def interrupt():
    signal.raise_signal(signal.SIGINT)
    while rclpy.ok():
        time.sleep(0.01)
    print("went on")

class Interrupted(Node):
    def __init__(self):
        super().__init__("interrupted")
        if {where!r} == "creating":
            interrupt()
        self.publisher = self.create_publisher(String, "/name", 1)
        self.create_timer(0.01, self.work)

    def work(self):
        if {where!r} == "in a callback":
            interrupt()
            self.publisher.publish(String())
        raise RuntimeError("an error of its own")

run_node(Interrupted)
"""


@pytest.mark.parametrize("where", ["creating", "in a callback"])
def test_an_interrupt_ends_the_node_at_its_next_call(start, where) -> None:
    """It raises nothing where it arrives, as rclpy does not expect it everywhere."""
    node = start([sys.executable, "-c", NODE.format(where=where)])
    assert node.wait() == 0, node
    assert "went on" in node.output, node
    assert "Traceback" not in node.output, node


def test_an_error_of_the_node_is_reported(start) -> None:
    node = start([sys.executable, "-c", NODE.format(where="nowhere")])
    assert node.wait() == 1, node
    assert "an error of its own" in node.output, node


MATCHING_NODE = """
import rclpy
from rclpy.node import Node
from rmw_manycore_py.ndt.nodes.scan_matcher.matching_thread import MatchingThread
from rmw_manycore_py.ndt.nodes.scan_matcher.scan_inbox import ScanInbox
from rmw_manycore_py.ndt.nodes.support.running import run_node

def fail():
    raise RuntimeError("an error of its thread")

class Matching(Node):
    def __init__(self):
        super().__init__("matching")
        inbox, is_over = ScanInbox(lambda _: True, 0.0), lambda: not self.context.ok()
        self.thread = MatchingThread(inbox, print, print, is_over, rclpy.try_shutdown)
        self.thread.post(fail)

    def destroy_node(self):
        self.thread.close()

run_node(Matching)
"""


def test_an_error_of_the_matching_thread_is_reported(start) -> None:
    """The thread shuts the context down, as an interrupt does."""
    node = start([sys.executable, "-c", MATCHING_NODE])
    assert node.wait() == 1, node
    assert "MatchingError: an error of its thread" in node.output, node
