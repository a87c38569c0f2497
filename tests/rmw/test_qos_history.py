# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""History, durability and lifespan: which messages a subscription still gets."""

from __future__ import annotations

import time

import pytest
import rclpy
from rclpy._rclpy_pybind11 import RCLError
from rclpy.duration import Duration, Infinite
from rclpy.qos import (
    DurabilityPolicy,
    HistoryPolicy,
    LivelinessPolicy,
    QoSPresetProfiles,
    QoSProfile,
    ReliabilityPolicy,
)
from std_msgs.msg import String, UInt8MultiArray

from support import IS_MANYCORE
from support.nodes.ros import announce, peer_node, spin, spin_until

TRANSIENT_LOCAL = DurabilityPolicy.TRANSIENT_LOCAL
LIFESPAN = Duration(seconds=0.1)


def publish_burst(count: int, depth: int, end: bool) -> None:
    """Publish 0 to count - 1 at once, then "end" on another topic once that has a reader."""
    with peer_node() as node:
        publisher = node.create_publisher(String, "numbers", depth)
        end_publisher = node.create_publisher(String, "end", 1)
        spin_until(node, publisher.get_subscription_count)
        for number in range(count):
            publisher.publish(String(data=str(number)))
        announce("published")
        if end:
            spin_until(node, end_publisher.get_subscription_count)
            end_publisher.publish(String())
        spin(node)


def receive_after_burst(node, start_peer, cluster, qos, count):
    """Return the messages that a subscription not taken from during a burst still holds."""
    received, ended = [], []
    node.create_subscription(String, "numbers", lambda m: received.append(int(m.data)), qos)
    node.create_subscription(String, "end", ended.append, 1)
    peer = start_peer(publish_burst, count, count, True, cluster=cluster)
    peer.wait_for("published")
    spin_until(node, lambda: ended)
    spin_until(node, lambda: count - 1 in received)
    return received


def test_keep_last_keeps_the_newest(node, start_peer, peer_cluster):
    received = receive_after_burst(node, start_peer, peer_cluster, 3, 10)
    assert received == [7, 8, 9]


def test_depth_of_one(node, start_peer, peer_cluster):
    assert receive_after_burst(node, start_peer, peer_cluster, 1, 10) == [9]


def test_keep_all_keeps_all(node, start_peer, peer_cluster):
    qos = QoSProfile(history=HistoryPolicy.KEEP_ALL)
    assert receive_after_burst(node, start_peer, peer_cluster, qos, 500) == list(range(500))


@pytest.mark.skipif(not IS_MANYCORE, reason="sizes are of platforms")
def test_keep_all_ignores_its_depth(node):
    everything = QoSProfile(history=HistoryPolicy.KEEP_ALL, depth=2_000_000)
    taken = []
    node.create_subscription(String, "numbers", taken.append, everything)
    publisher = node.create_publisher(String, "numbers", everything)
    spin_until(node, publisher.get_subscription_count)
    publisher.publish(String(data="0"))
    spin_until(node, lambda: taken == [String(data="0")])


def test_keep_all_blocks_the_publisher_up_to_its_bound(small_topic):
    """Reliable and keep all: nothing is overwritten; publishing fails while the ring is full."""
    qos = QoSProfile(history=HistoryPolicy.KEEP_ALL, reliability=ReliabilityPolicy.RELIABLE)
    node, received = rclpy.create_node("tester"), []
    node.create_subscription(String, small_topic, lambda m: received.append(int(m.data)), qos)
    publisher = node.create_publisher(String, small_topic, qos)
    spin_until(node, publisher.get_subscription_count)
    published = publish_until_refused(publisher)
    assert 10 < published < 200  # 8 KiB
    with pytest.raises(RCLError, match="has not taken its messages for 100 ms"):
        publisher.publish(String(data=str(published)))
    spin_until(node, lambda: len(received) == published)
    publisher.publish(String(data=str(published)))
    spin_until(node, lambda: len(received) == published + 1)
    assert received == list(range(published + 1))


def publish_until_refused(publisher) -> int:
    for number in range(10_000):
        try:
            publisher.publish(String(data=str(number)))
        except RCLError:
            return number
    raise AssertionError("never refused")


def test_depth_is_reached_with_large_messages(node, start_peer, peer_cluster):
    """Ten messages of 1 MiB fit a depth of ten: a topic DSM without a fixed size grows."""
    received, ended = [], []
    node.create_subscription(UInt8MultiArray, "large", received.append, 10)
    node.create_subscription(String, "end", ended.append, 1)
    peer = start_peer(publish_large, cluster=peer_cluster)
    peer.wait_for("published")
    spin_until(node, lambda: ended)
    spin_until(node, lambda: len(received) == 10)
    assert [(m.data[0], m.data[-1], len(m.data)) for m in received] == [
        (number, number, 1 << 20) for number in range(10)
    ]


def publish_large() -> None:
    with peer_node() as node:
        publisher = node.create_publisher(UInt8MultiArray, "large", 10)
        end_publisher = node.create_publisher(String, "end", 1)
        spin_until(node, publisher.get_subscription_count)
        for number in range(10):
            publisher.publish(UInt8MultiArray(data=bytes([number]) * (1 << 20)))
        announce("published")
        spin_until(node, end_publisher.get_subscription_count)
        end_publisher.publish(String())
        rclpy.spin(node)


def publish_history(count: int, depth: int) -> None:
    """Publish 0 to count - 1 for late readers."""
    with peer_node() as node:
        qos = QoSProfile(depth=depth, durability=TRANSIENT_LOCAL)
        publisher = node.create_publisher(String, "numbers", qos)
        for number in range(count):
            publisher.publish(String(data=str(number)))
        announce("published")
        spin_until(node, publisher.get_subscription_count)
        publisher.publish(String(data="-1"))
        rclpy.spin(node)


@pytest.mark.parametrize(("writer_depth", "reader_depth", "kept"), [(5, 20, 5), (20, 20, 10)])
def test_late_joiner_gets_the_history(
    node, start_peer, peer_cluster, writer_depth, reader_depth, kept
):
    peer = start_peer(publish_history, 10, writer_depth, cluster=peer_cluster)
    peer.wait_for("published")
    received = []
    qos = QoSProfile(depth=reader_depth, durability=TRANSIENT_LOCAL)
    node.create_subscription(String, "numbers", lambda m: received.append(int(m.data)), qos)
    spin_until(node, lambda: -1 in received)
    assert received == [*range(10 - kept, 10), -1]


def test_late_joiner_that_is_volatile_gets_only_the_new(node, start_peer, peer_cluster):
    peer = start_peer(publish_history, 10, 10, cluster=peer_cluster)
    peer.wait_for("published")
    received = []
    node.create_subscription(String, "numbers", lambda m: received.append(int(m.data)), 20)
    spin_until(node, lambda: -1 in received)
    assert received == [-1]


def test_late_joiner_of_the_same_process(node):
    qos = QoSProfile(depth=3, durability=TRANSIENT_LOCAL)
    publisher = node.create_publisher(String, "numbers", qos)
    for number in range(5):
        publisher.publish(String(data=str(number)))
    received = []
    node.create_subscription(String, "numbers", lambda m: received.append(int(m.data)), qos)
    spin_until(node, lambda: len(received) == 3)
    assert received == [2, 3, 4]


@pytest.mark.parametrize("side", ["publisher", "subscription"])
def test_expired_messages_are_not_delivered(node, start_peer, peer_cluster, side):
    """The lifespan expires while the message waits; later messages mark the end.

    Each of them may expire, too, where the subscription has the lifespan and the machine is busy.
    """
    if side == "publisher" and not IS_MANYCORE:
        pytest.skip("Fast DDS only looks at the subscription's lifespan")
    received = []
    qos = 10 if side == "publisher" else QoSProfile(depth=10, lifespan=LIFESPAN)
    node.create_subscription(String, "numbers", lambda m: received.append(m.data), qos)
    peer = start_peer(publish_short_lived, side == "publisher", cluster=peer_cluster)
    peer.wait_for("published")
    time.sleep(0.3)  # the lifespan itself, not a wait for something to happen
    peer.say("go on")
    spin_until(node, lambda: "lasting" in received)
    assert set(received) == {"lasting"}


def publish_short_lived(has_lifespan: bool) -> None:
    with peer_node() as node:
        short = QoSProfile(depth=10, lifespan=LIFESPAN) if has_lifespan else 10
        expiring = node.create_publisher(String, "numbers", short)
        lasting = node.create_publisher(String, "numbers", 10)
        for publisher in (expiring, lasting):
            spin_until(node, publisher.get_subscription_count)
        expiring.publish(String(data="short-lived"))
        announce("published")
        input()
        node.create_timer(0.02, lambda: lasting.publish(String(data="lasting")))
        rclpy.spin(node)


def test_a_reader_takes_what_a_publisher_left(node, start_peer, peer_cluster):
    """Messages published before the publisher was destroyed are not lost."""
    if not IS_MANYCORE:
        pytest.skip("a DDS writer takes its unread samples with it")
    received = []
    node.create_subscription(String, "numbers", lambda m: received.append(int(m.data)), 10)
    peer = start_peer(publish_burst, 5, 5, False, cluster=peer_cluster)
    peer.wait_for("published")
    peer.wait_for("^spinning$")
    assert peer.stop_node()
    spin_until(node, lambda: len(received) == 5)
    assert received == [0, 1, 2, 3, 4]


def test_system_default_and_best_available(node):
    """Profiles that leave a choice to the middleware come back with the chosen policies."""
    received = []
    publisher = node.create_publisher(
        String, "chatter", QoSProfile(depth=1, reliability=ReliabilityPolicy.BEST_EFFORT)
    )
    available = QoSProfile(
        depth=1,
        reliability=ReliabilityPolicy.BEST_AVAILABLE,
        durability=DurabilityPolicy.BEST_AVAILABLE,
    )
    spin_until(node, lambda: node.count_publishers("chatter"))
    subscription = node.create_subscription(String, "chatter", received.append, available)
    spin_until(node, publisher.get_subscription_count)
    publisher.publish(String())
    spin_until(node, lambda: received)
    info = node.get_subscriptions_info_by_topic(subscription.topic_name)[0].qos_profile
    assert info.reliability == ReliabilityPolicy.BEST_EFFORT
    assert info.durability == DurabilityPolicy.VOLATILE


MANUAL = QoSProfile(
    depth=1,
    deadline=Duration(seconds=3),
    liveliness=LivelinessPolicy.MANUAL_BY_TOPIC,
    liveliness_lease_duration=Duration(seconds=5),
)


def profile_of(infos) -> QoSProfile:
    return infos[0].qos_profile


def check_times_are_those_of_manual(profile: QoSProfile) -> None:
    assert profile.deadline == MANUAL.deadline
    assert profile.liveliness == MANUAL.liveliness
    assert profile.liveliness_lease_duration == MANUAL.liveliness_lease_duration


def test_best_available_deadline_and_liveliness(node):
    """Each side adopts the policies of the other one."""
    node.create_publisher(String, "offered", MANUAL)
    node.create_subscription(String, "requested", lambda _: None, MANUAL)
    spin_until(node, lambda: node.count_publishers("offered"))
    spin_until(node, lambda: node.count_subscribers("requested"))
    publisher = node.create_publisher(String, "requested", QoSPresetProfiles.BEST_AVAILABLE.value)
    node.create_subscription(
        String, "offered", lambda _: None, QoSPresetProfiles.BEST_AVAILABLE.value
    )
    spin_until(node, lambda: node.get_subscriptions_info_by_topic("offered"))
    spin_until(node, publisher.get_subscription_count)
    check_times_are_those_of_manual(profile_of(node.get_subscriptions_info_by_topic("offered")))
    check_times_are_those_of_manual(profile_of(node.get_publishers_info_by_topic("requested")))


def test_best_available_without_peers(node):
    """Without a publisher, best available resolves to the strongest policies."""
    node.create_subscription(
        String, "chatter", lambda _: None, QoSPresetProfiles.BEST_AVAILABLE.value
    )
    spin_until(node, lambda: node.get_subscriptions_info_by_topic("chatter"))
    profile = profile_of(node.get_subscriptions_info_by_topic("chatter"))
    assert profile.reliability == ReliabilityPolicy.RELIABLE
    assert profile.durability == TRANSIENT_LOCAL
    assert profile.liveliness == LivelinessPolicy.MANUAL_BY_TOPIC
    assert profile.deadline == profile.liveliness_lease_duration == Infinite


def test_system_default(node):
    profile = QoSPresetProfiles.SYSTEM_DEFAULT.value
    node.create_publisher(String, "chatter", profile)
    node.create_subscription(String, "chatter", lambda _: None, profile)
    spin_until(node, lambda: node.get_publishers_info_by_topic("chatter"))
    spin_until(node, lambda: node.get_subscriptions_info_by_topic("chatter"))
    published = profile_of(node.get_publishers_info_by_topic("chatter"))
    subscribed = profile_of(node.get_subscriptions_info_by_topic("chatter"))
    assert published.reliability == ReliabilityPolicy.RELIABLE
    assert published.durability == TRANSIENT_LOCAL
    assert subscribed.reliability == ReliabilityPolicy.BEST_EFFORT
    assert subscribed.durability == DurabilityPolicy.VOLATILE
    for chosen in (published, subscribed):
        assert chosen.deadline == chosen.lifespan == chosen.liveliness_lease_duration == Infinite
        assert chosen.liveliness == LivelinessPolicy.AUTOMATIC
