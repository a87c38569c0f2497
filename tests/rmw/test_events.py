# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""Events: matched, incompatible QoS and type, lost messages; and refused policies."""

from __future__ import annotations

import pytest
import rclpy
from rclpy._rclpy_pybind11 import RCLError
from rclpy.duration import Duration
from rclpy.event_handler import (
    PublisherEventCallbacks,
    QoSPublisherMatchedInfo,
    QoSSubscriptionMatchedInfo,
    SubscriptionEventCallbacks,
)
from rclpy.qos import (
    DurabilityPolicy,
    LivelinessPolicy,
    QoSPolicyKind,
    QoSProfile,
    ReliabilityPolicy,
)
from std_msgs.msg import Int32, String

from support import IS_MANYCORE
from support.nodes.ros import announce, peer_node, spin, spin_until

BEST_EFFORT = QoSProfile(depth=10, reliability=ReliabilityPolicy.BEST_EFFORT)
VOLATILE = QoSProfile(depth=10)
TRANSIENT_LOCAL = QoSProfile(depth=10, durability=DurabilityPolicy.TRANSIENT_LOCAL)

STRICT = QoSProfile(
    depth=10,
    durability=DurabilityPolicy.TRANSIENT_LOCAL,
    deadline=Duration(seconds=1),
    liveliness=LivelinessPolicy.MANUAL_BY_TOPIC,
)

# QoS offered and requested, and the policy that the event names: of several, the highest number.
INCOMPATIBLE = {
    "reliability": (BEST_EFFORT, VOLATILE, QoSPolicyKind.RELIABILITY),
    "durability": (VOLATILE, TRANSIENT_LOCAL, QoSPolicyKind.DURABILITY),
    "all": (BEST_EFFORT, STRICT, QoSPolicyKind.RELIABILITY),
    "all but reliability": (VOLATILE, STRICT, QoSPolicyKind.LIVELINESS),
}


def offer(policy: str) -> None:
    """Publish with weaker QoS than the test requests, and print when the event arrives."""
    with peer_node() as node:
        events = PublisherEventCallbacks(
            incompatible_qos=lambda event: announce(f"event {event.last_policy_kind!r}")
        )
        publisher = node.create_publisher(
            String, "chatter", INCOMPATIBLE[policy][0], event_callbacks=events
        )
        node.create_timer(0.02, lambda: publisher.publish(String()))
        rclpy.spin(node)


@pytest.mark.parametrize("policy", INCOMPATIBLE)
def test_incompatible_qos(node, start_peer, peer_cluster, policy):
    _, requested, kind = INCOMPATIBLE[policy]
    received, events = [], []
    callbacks = SubscriptionEventCallbacks(incompatible_qos=events.append)
    node.create_subscription(
        String, "chatter", received.append, requested, event_callbacks=callbacks
    )
    peer = start_peer(offer, policy, cluster=peer_cluster)
    spin_until(node, lambda: events)
    assert peer.wait_for(r"event .*?(\d+)>?$").group(1) == str(int(kind))
    assert (events[0].total_count, events[0].total_count_change) == (1, 1)
    assert events[0].last_policy_kind == kind
    assert received == []


def test_incompatible_qos_is_logged(node, start_peer):
    """Without callbacks rclpy logs the event, on both sides."""
    node.create_subscription(String, "chatter", lambda _: None, 10)
    peer = start_peer(publish_best_effort, cluster=2)
    peer.wait_for(r"incompatible QoS.*RELIABILITY")


def publish_best_effort() -> None:
    with peer_node() as node:
        node.create_publisher(String, "chatter", BEST_EFFORT)
        rclpy.spin(node)


def test_matched(node, start_peer, peer_cluster):
    published: list[QoSPublisherMatchedInfo] = []
    subscribed: list[QoSSubscriptionMatchedInfo] = []
    node.create_publisher(
        String,
        "to_peer",
        10,
        event_callbacks=PublisherEventCallbacks(matched=published.append),
    )
    node.create_subscription(
        String,
        "from_peer",
        lambda _: None,
        10,
        event_callbacks=SubscriptionEventCallbacks(matched=subscribed.append),
    )
    peer = start_peer(match, cluster=peer_cluster)
    spin_until(node, lambda: published and subscribed)
    for event in (published[-1], subscribed[-1]):
        assert (event.total_count, event.current_count) == (1, 1)
        assert (event.total_count_change, event.current_count_change) == (1, 1)
    peer.wait_for("^spinning$")
    assert peer.stop_node()
    spin_until(node, lambda: len(published) == 2 and len(subscribed) == 2)
    for event in (published[-1], subscribed[-1]):
        assert (event.total_count, event.current_count) == (1, 0)
        assert (event.total_count_change, event.current_count_change) == (0, -1)


def match() -> None:
    with peer_node() as node:
        node.create_subscription(String, "to_peer", lambda _: None, 10)
        node.create_publisher(String, "from_peer", 10)
        spin(node)


def test_messages_that_were_overwritten_are_reported_as_lost(node, start_peer, peer_cluster):
    if not IS_MANYCORE:
        pytest.skip("Fast DDS does not count what its own history dropped")
    received, lost = [], []
    callbacks = SubscriptionEventCallbacks(message_lost=lost.append)
    node.create_subscription(String, "chatter", received.append, 3, event_callbacks=callbacks)
    peer = start_peer(publish_ten, cluster=peer_cluster)
    peer.wait_for("published")
    spin_until(node, lambda: lost and lost[-1].total_count == 7)
    spin_until(node, lambda: len(received) == 3)
    assert sum(event.total_count_change for event in lost) == 7


def test_messages_that_a_newer_one_replaced_are_not_lost(node, start_peer, peer_cluster):
    """Known once a deeper subscription, which does lose some, has been told."""
    if not IS_MANYCORE:
        pytest.skip("Fast DDS does not count what its own history dropped")
    received: dict[int, list] = {1: [], 3: []}
    lost: dict[int, list] = {1: [], 3: []}
    for depth in (1, 3):
        told = SubscriptionEventCallbacks(message_lost=lost[depth].append)
        heard = received[depth].append
        node.create_subscription(String, "chatter", heard, depth, event_callbacks=told)
    peer = start_peer(publish_ten, cluster=peer_cluster)
    peer.wait_for("published")
    spin_until(node, lambda: received[1] and lost[3] and lost[3][-1].total_count == 7)
    assert lost[1] == []


def publish_ten() -> None:
    with peer_node() as node:
        publisher = node.create_publisher(String, "chatter", 10)
        spin_until(node, publisher.get_subscription_count)
        for _ in range(10):
            publisher.publish(String())
        announce("published")
        rclpy.spin(node)


@pytest.mark.skipif(not IS_MANYCORE, reason="Fast DDS supports the event but never tells of one")
def test_incompatible_type(node, start_peer, peer_cluster):
    """rclpy provides no counts in this event."""
    events = []
    callbacks = SubscriptionEventCallbacks(incompatible_type=events.append)
    node.create_subscription(String, "chatter", lambda _: None, 10, event_callbacks=callbacks)
    peer = start_peer(publish_number, cluster=peer_cluster)
    spin_until(node, lambda: events)
    peer.wait_for("incompatible type")


def publish_number() -> None:
    with peer_node() as node:
        events = PublisherEventCallbacks(incompatible_type=lambda _: announce("incompatible type"))
        node.create_publisher(Int32, "chatter", 10, event_callbacks=events)
        rclpy.spin(node)


@pytest.mark.parametrize("side", ["publisher", "subscription"])
def test_a_policy_without_a_meaning_is_refused(node, capfd, side):
    unknown = QoSProfile(depth=1, liveliness=LivelinessPolicy.UNKNOWN)
    create = {
        "publisher": lambda: node.create_publisher(String, "chatter", unknown),
        "subscription": lambda: node.create_subscription(String, "chatter", print, unknown),
    }
    with pytest.raises(RCLError) as raised:
        create[side]()
    # rcl drops the error text of a subscription that it could not create, so it is logged, too.
    assert "liveliness" in str(raised.value).lower() + capfd.readouterr().err.lower()
