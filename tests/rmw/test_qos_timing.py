# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""DEADLINE and LIVELINESS: what their events count, and that time alone triggers them."""

from __future__ import annotations

import os
import re
import time
from pathlib import Path
from typing import Any

import pytest
import rclpy
from rclpy.duration import Duration
from rclpy.event_handler import PublisherEventCallbacks, SubscriptionEventCallbacks
from rclpy.experimental import EventsExecutor
from rclpy.qos import LivelinessPolicy, QoSPolicyKind, QoSProfile
from std_msgs.msg import String

from support import IS_MANYCORE, TIMEOUT_S, wait_until
from support.nodes.ros import announce, peer_node, spin_until

SHORT_S, LONG_S = 0.1, 3600.0
LEASE_S = 1.0
MANUAL = LivelinessPolicy.MANUAL_BY_TOPIC


def deadline(seconds: float) -> QoSProfile:
    return QoSProfile(depth=10, deadline=Duration(seconds=seconds))


def lease(seconds: float, liveliness: LivelinessPolicy = MANUAL) -> QoSProfile:
    return QoSProfile(
        depth=10, liveliness=liveliness, liveliness_lease_duration=Duration(seconds=seconds)
    )


def subscribe(node, qos, **callbacks: Any) -> None:
    node.create_subscription(
        String,
        "chatter",
        lambda _: None,
        qos,
        event_callbacks=SubscriptionEventCallbacks(**callbacks),
    )


def publish_once(seconds: float) -> None:
    """Publish one message, and print each missed deadline of the publisher."""
    with peer_node() as node:
        events = PublisherEventCallbacks(
            deadline=lambda event: announce(f"missed {event.total_count}")
        )
        publisher = node.create_publisher(
            String, "chatter", deadline(seconds), event_callbacks=events
        )
        spin_until(node, publisher.get_subscription_count)
        publisher.publish(String())
        announce("published")
        rclpy.spin(node)


def test_missed_deadlines_are_counted_on_both_sides(node, start_peer, peer_cluster):
    missed = []
    subscribe(node, deadline(SHORT_S), deadline=missed.append)
    peer = start_peer(publish_once, SHORT_S, cluster=peer_cluster)
    spin_until(node, lambda: missed and missed[-1].total_count >= 3)
    assert sum(event.total_count_change for event in missed) == missed[-1].total_count
    peer.wait_for(r"missed ([3-9]|\d\d)")


def test_a_deadline_that_is_met_is_not_missed(node, start_peer, peer_cluster):
    missed, received = [], []
    subscribe(node, deadline(LONG_S), deadline=missed.append)
    node.create_subscription(String, "chatter", received.append, 10)
    peer = start_peer(publish_once, LONG_S, cluster=peer_cluster)
    spin_until(node, lambda: received)
    assert missed == []
    assert "missed" not in peer.output


def test_before_the_first_message_no_deadline_is_missed(node):
    missed = []
    publisher = node.create_publisher(
        String,
        "chatter",
        deadline(0.01),
        event_callbacks=PublisherEventCallbacks(deadline=missed.append),
    )
    subscribe(node, deadline(0.01), deadline=missed.append)
    spin_until(node, publisher.get_subscription_count)
    time.sleep(0.05)  # some periods, not a wait for something to happen
    rclpy.spin_once(node, timeout_sec=0)
    assert missed == []


def test_deadlines_missed_unwatched_are_reported_together(node):
    missed = []
    publisher = node.create_publisher(
        String,
        "chatter",
        deadline(0.02),
        event_callbacks=PublisherEventCallbacks(deadline=missed.append),
    )
    publisher.publish(String())
    time.sleep(0.1)  # five periods
    spin_until(node, lambda: missed)
    assert missed[0].total_count_change == missed[0].total_count >= 4


def test_a_wait_ends_when_a_deadline_falls_due(node):
    """If time did not end the wait, the event would report the misses of the whole timeout."""
    missed = []
    publisher = node.create_publisher(
        String,
        "chatter",
        deadline(SHORT_S),
        event_callbacks=PublisherEventCallbacks(deadline=missed.append),
    )
    publisher.publish(String())
    while not missed:
        rclpy.spin_once(node, timeout_sec=TIMEOUT_S)
    assert missed[0].total_count < TIMEOUT_S / SHORT_S / 2


def test_a_wait_ends_when_a_lease_runs_out(node):
    lost, missed = [], []
    events = PublisherEventCallbacks(liveliness=lost.append, deadline=missed.append)
    qos = lease(5 * SHORT_S)
    qos.deadline = Duration(seconds=SHORT_S)
    publisher = node.create_publisher(String, "chatter", qos, event_callbacks=events)
    publisher.publish(String())
    while not lost:
        rclpy.spin_once(node, timeout_sec=TIMEOUT_S)
    assert missed[-1].total_count < TIMEOUT_S / SHORT_S / 2


def test_a_longer_deadline_is_incompatible(node):
    offered, requested = [], []
    node.create_publisher(
        String,
        "chatter",
        deadline(2),
        event_callbacks=PublisherEventCallbacks(incompatible_qos=offered.append),
    )
    subscribe(node, deadline(1), incompatible_qos=requested.append)
    spin_until(node, lambda: offered and requested)
    assert offered[0].last_policy_kind == requested[0].last_policy_kind == QoSPolicyKind.DEADLINE


def test_events_executor_hears_of_missed_deadlines(node):
    """No thread is in a wait set and no message arrives: the timer alone calls the callback."""
    missed = []
    publisher = node.create_publisher(
        String,
        "chatter",
        deadline(SHORT_S),
        event_callbacks=PublisherEventCallbacks(deadline=missed.append),
    )
    executor = EventsExecutor()
    executor.add_node(node)
    executor.spin_once(0.3)  # the thread that watches deadlines has found none due, and sleeps
    publisher.publish(String())
    end = time.monotonic() + TIMEOUT_S
    while not missed or missed[-1].total_count < 3:
        assert time.monotonic() < end
        executor.spin_once(1.0)
    executor.shutdown()


def assert_when_told(seconds: float) -> None:
    """Assert manual liveliness on request; print leases that ran out."""
    with peer_node() as node:
        events = PublisherEventCallbacks(
            liveliness=lambda event: announce(f"lost {event.total_count}")
        )
        publisher = node.create_publisher(String, "chatter", lease(seconds), event_callbacks=events)
        spin_until(node, publisher.get_subscription_count)
        while (word := input()) != "spin":
            if word == "assert":
                publisher.assert_liveliness()
            else:
                announce("asserted")
        rclpy.spin(node)


def test_manual_liveliness_is_lost_on_both_sides(node, start_peer, peer_cluster):
    """A lease may run out before the event is taken: the peer asserts it until that happened."""
    changes = []
    subscribe(node, lease(LEASE_S), liveliness=changes.append)
    peer = start_peer(assert_when_told, LEASE_S, cluster=peer_cluster)
    for _ in range(2):
        spin_until(node, lambda: peer.say("assert") or (changes and changes[-1].alive_count == 1))
        peer.say("that is all")
        peer.wait_for("asserted")
        spin_until(node, lambda: changes[-1].not_alive_count == 1)
        assert (changes[-1].alive_count, changes[-1].alive_count_change) == (0, -1)
    peer.say("spin")
    peer.wait_for(r"lost ([2-9]|\d\d)")
    assert sum(event.not_alive_count_change for event in changes) == 1


def test_a_message_asserts_manual_liveliness(node):
    changes = []
    subscribe(node, lease(LONG_S), liveliness=changes.append)
    publisher = node.create_publisher(String, "chatter", lease(LONG_S))
    spin_until(node, publisher.get_subscription_count)
    publisher.publish(String())
    spin_until(node, lambda: changes)
    assert (changes[0].alive_count, changes[0].not_alive_count) == (1, 0)
    node.destroy_publisher(publisher)
    spin_until(node, lambda: len(changes) == 2)
    assert (changes[1].alive_count, changes[1].alive_count_change) == (0, -1)
    assert (changes[1].not_alive_count, changes[1].not_alive_count_change) == (0, 0)


def publish_alive(kind: str, seconds: float) -> None:
    with peer_node() as node:
        publisher = node.create_publisher(String, "chatter", lease(seconds, LivelinessPolicy[kind]))
        spin_until(node, publisher.get_subscription_count)
        publisher.publish(String())
        rclpy.spin(node)


@pytest.mark.skipif(not IS_MANYCORE, reason="Fast DDS notices a death when the lease is over")
@pytest.mark.parametrize("kind", ["AUTOMATIC", "MANUAL_BY_TOPIC"])
def test_a_killed_publisher_is_noticed_long_before_its_lease_is_over(
    node, start_peer, peer_cluster, kind
):
    changes = []
    subscribe(node, lease(LONG_S, LivelinessPolicy[kind]), liveliness=changes.append)
    peer = start_peer(publish_alive, kind, LONG_S, cluster=peer_cluster)
    spin_until(node, lambda: changes and changes[-1].alive_count == 1)
    peer.kill()
    spin_until(node, lambda: changes[-1].not_alive_count == 1)
    assert changes[-1].alive_count == 0


def test_events_executor_hears_of_lost_liveliness(node, start_peer, peer_cluster):
    changes = []
    subscribe(node, lease(SHORT_S), liveliness=changes.append)
    executor = EventsExecutor()
    executor.add_node(node)
    start_peer(publish_alive, "MANUAL_BY_TOPIC", SHORT_S, cluster=peer_cluster)
    end = time.monotonic() + TIMEOUT_S
    while not changes or changes[-1].not_alive_count == 0:
        assert time.monotonic() < end
        executor.spin_once(1.0)
    executor.shutdown()


def test_weaker_liveliness_is_incompatible(node):
    requested = []
    node.create_publisher(String, "chatter", 10)
    subscribe(node, lease(1), incompatible_qos=requested.append)
    spin_until(node, lambda: requested)
    assert requested[0].last_policy_kind == QoSPolicyKind.LIVELINESS


@pytest.mark.skipif(not IS_MANYCORE, reason="Fast DDS tells of liveliness only with a lease")
def test_default_liveliness_follows_matches(node):
    changes = []
    subscribe(node, 10, liveliness=changes.append)
    publisher = node.create_publisher(String, "chatter", 10)
    spin_until(node, lambda: changes and changes[-1].alive_count == 1)
    node.destroy_publisher(publisher)
    spin_until(node, lambda: changes[-1].alive_count == 0)
    assert changes[-1].not_alive_count == 0


@pytest.mark.skipif(not IS_MANYCORE, reason="Fast DDS has timers anyway")
@pytest.mark.parametrize("period_s", [None, 0.02], ids=["no_policy", "deadline"])
def test_without_a_policy_nobody_wakes_up(start_peer, peer_cluster, period_s):
    """A waiting node without a timed policy does not wake up; with one, its wake-ups are seen."""
    silent = period_s is None
    one, other = (start_peer(wait_for_events, period_s, cluster=c) for c in (1, peer_cluster))
    for peer in (one, other):
        peer.wait_for("matched")
    wait_until(lambda: are_silent(one, other) == silent, "nothing or something wakes them")


def are_silent(*peers) -> bool:
    """Return whether no thread wakes up during a second."""
    before = [switches(peer) for peer in peers]
    time.sleep(1.0)  # the time measured, not a wait for something to happen
    return [switches(peer) for peer in peers] == before


def switches(peer) -> int:
    """Return how often the threads of a process have gone to sleep."""
    threads = Path(f"/proc/{peer.pid}/task").glob("*/status")
    pattern = re.compile(r"^voluntary_ctxt_switches:\s+(\d+)", re.MULTILINE)
    return sum(int(pattern.search(status.read_text())[1]) for status in threads)


def wait_for_events(period_s: float | None) -> None:
    """Wait for messages and all events of a publisher and a subscription."""
    qos = 10 if period_s is None else deadline(period_s)
    told = []

    def deny(event) -> None:
        told.append(event)

    with peer_node(f"peer_{os.getpid()}") as node:
        publisher = node.create_publisher(
            String, "chatter", qos, event_callbacks=PublisherEventCallbacks(deadline=deny)
        )
        subscribe(node, qos, deadline=deny, liveliness=deny)
        spin_until(node, lambda: publisher.get_subscription_count() == 2)
        publisher.publish(String())
        announce("matched")
        rclpy.spin(node)
