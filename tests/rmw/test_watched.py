# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""A watch of a topic names the publishers that have ended, where it can tell them apart."""

from __future__ import annotations

import pytest
import rclpy
from rclpy.duration import Duration
from rclpy.event_handler import SubscriptionEventCallbacks
from rclpy.node import Node
from rclpy.qos import LivelinessPolicy, QoSProfile
from std_msgs.msg import String

from rmw_manycore_py.ndt.nodes.support.watched import watched
from support.nodes.ros import spin_until

BY_HAND = QoSProfile(
    depth=1,
    liveliness=LivelinessPolicy.MANUAL_BY_TOPIC,
    liveliness_lease_duration=Duration(seconds=3),  # longer than this process may not run
)


@pytest.fixture
def sources(node: Node):
    """Yield two nodes with a publisher each, by their names; a watch has seen both."""
    node.create_subscription(
        String, "news", lambda _: None, BY_HAND, event_callbacks=watched(node, "news")
    )
    nodes = {name: rclpy.create_node(name) for name in ("north", "south")}
    publishers = {
        name: one.create_publisher(String, "news", BY_HAND) for name, one in nodes.items()
    }
    alive: list[int] = []
    counting = SubscriptionEventCallbacks(liveliness=lambda event: alive.append(event.alive_count))
    node.create_subscription(String, "news", lambda _: None, BY_HAND, event_callbacks=counting)

    def both_are_alive() -> bool:
        for publisher in publishers.values():
            publisher.assert_liveliness()
        return 2 in alive[-1:]

    spin_until(node, both_are_alive)
    rclpy.spin_once(node, timeout_sec=0.1)  # the watch's own event, if it has not arrived yet
    yield nodes, publishers
    for one in nodes.values():
        one.destroy_node()


def said(capfd: pytest.CaptureFixture[str], heard: list[str], words: str) -> bool:
    """Return whether a line of the log contains these words."""
    heard.append(capfd.readouterr().err)
    return words in "".join(heard)


def test_a_publisher_that_left_is_named_alone(node, sources, capfd):
    nodes, publishers = sources
    heard: list[str] = []

    nodes["north"].destroy_publisher(publishers.pop("north"))

    def left() -> bool:
        publishers["south"].assert_liveliness()
        return said(capfd, heard, "/news: north is gone")

    spin_until(node, left)


def test_where_one_of_several_falls_silent_all_of_them_may_be_it(node, sources, capfd):
    _, publishers = sources
    heard: list[str] = []

    def silent() -> bool:
        publishers["south"].assert_liveliness()
        return said(capfd, heard, "/news: north or south is gone")

    spin_until(node, silent)
