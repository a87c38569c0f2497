# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""Deadline, lifespan, liveliness and type hash through the bridge, in both directions."""

from __future__ import annotations

import signal
import time
from itertools import count
from typing import Any

import pytest

from support import IS_MANYCORE, wait_until
from support.nodes.bridging import STRING, Bridge
from support.nodes.ros import announce, peer_node, spin_until, type_of

pytestmark = [
    pytest.mark.integration,
    pytest.mark.skipif(not IS_MANYCORE, reason="the bridge is part of rmw_manycore"),
]

MS = 1_000_000
TIMES = ("deadline", "lifespan", "liveliness_lease_duration")


@pytest.fixture(params=["inward", "outward"])
def way(request) -> str:
    return str(request.param)


def sides(bridge: Bridge, way: str) -> tuple[Any, Any]:
    """Return the functions that start a peer on the publisher's side and on the other one."""
    pair = bridge.outside, bridge.inside
    return pair if way == "inward" else (pair[1], pair[0])


def qos(words: dict[str, Any]) -> Any:
    """Return a profile from JSON values; times in milliseconds."""
    from rclpy.duration import Duration
    from rclpy.qos import DurabilityPolicy, LivelinessPolicy, QoSProfile

    latched = words.get("latched", False)
    by_hand = words.get("by_hand", False)
    return QoSProfile(
        depth=10,
        durability=DurabilityPolicy.TRANSIENT_LOCAL if latched else DurabilityPolicy.VOLATILE,
        liveliness=LivelinessPolicy.MANUAL_BY_TOPIC if by_hand else LivelinessPolicy.AUTOMATIC,
        **{name: Duration(nanoseconds=words[name] * MS) for name in TIMES if name in words},
    )


def say(words: dict[str, Any], period_s: float) -> None:
    """Publish a number once a period, the first at once; on request only assert liveliness."""
    told: list[int] = []
    signal.signal(signal.SIGUSR1, lambda number, _: told.append(number))
    with peer_node("speaker") as node:
        message = type_of(STRING)
        publisher = node.create_publisher(message, "/topic", qos(words))
        numbers = count()

        def publish() -> None:
            if not told:
                publisher.publish(message(data=str(next(numbers))))

        publish()
        node.create_timer(period_s, publish)
        announce("said")
        spin_until(node, lambda: False, 1e6)


def hear(words: dict[str, Any]) -> None:
    """Print each message received, and the events of its publishers."""
    from rclpy.event_handler import SubscriptionEventCallbacks

    with peer_node("hearer") as node:
        events = SubscriptionEventCallbacks(
            deadline=lambda _: announce("deadline missed"),
            liveliness=lambda event: announce(f"alive {event.alive_count}"),
        )
        node.create_subscription(
            *(type_of(STRING), "/topic", lambda found: announce(f"heard {found.data}")),
            qos(words),
            event_callbacks=events,
        )
        announce("listening")
        spin_until(node, lambda: False, 1e6)


def show_publisher() -> None:
    """Print the times, the liveliness and the type hash of the first publisher discovered."""
    with peer_node("watcher") as node:
        spin_until(node, lambda: node.get_publishers_info_by_topic("/topic"))
        found = node.get_publishers_info_by_topic("/topic")[0]
        profile = found.qos_profile
        times = [getattr(profile, name).nanoseconds // MS for name in TIMES]
        announce(f"publisher {times} {profile.liveliness.name} {found.topic_type_hash}")


def test_times_liveliness_and_type_hash_are_the_same_on_both_sides(bridge, way) -> None:
    bridge.run(bridge.route(way, "/topic"))
    source, target = sides(bridge, way)
    words = {
        "deadline": 700,
        "lifespan": 800,
        "liveliness_lease_duration": 900,
        "by_hand": True,
    }
    source(say, words, 0.1)
    watchers = [side(show_publisher) for side in (source, target)]
    shown = [watcher.wait_for("^publisher (.*)$").group(1) for watcher in watchers]
    assert shown[0] == shown[1]
    assert shown[1].startswith("[700, 800, 900] MANUAL_BY_TOPIC RIHS01_")


def test_a_missed_deadline_is_noticed_on_the_other_side(bridge, way) -> None:
    bridge.run(bridge.route(way, "/topic"))
    source, target = sides(bridge, way)
    hearer = target(hear, {"deadline": 1000})
    hearer.wait_for("^listening$")
    speaker = source(say, {"deadline": 1000}, 0.05)
    hearer.wait_for("^heard")
    speaker.signal(signal.SIGUSR1)
    hearer.wait_for("^deadline missed$")


@pytest.mark.parametrize("by_hand", [False, True], ids=["automatic", "by hand"])
def test_a_lost_publisher_is_noticed_on_the_other_side(bridge, way, by_hand) -> None:
    bridge.run(bridge.route(way, "/topic"))
    source, target = sides(bridge, way)
    words = {"liveliness_lease_duration": 2000, "by_hand": by_hand}
    hearer = target(hear, words)
    hearer.wait_for("^listening$")
    speaker = source(say, words, 0.05)
    hearer.wait_for("^alive 1$")
    hearer.wait_for("^heard")
    if by_hand:
        speaker.signal(signal.SIGUSR1)  # its silence is enough
    else:
        speaker.stop()
    hearer.wait_for("^alive 0$")


def test_what_has_expired_is_not_heard(bridge, way) -> None:
    bridge.run(bridge.route(way, "/topic"))
    source, target = sides(bridge, way)
    source(say, {"latched": True, "lifespan": 500}, 5.0).wait_for("^said$")
    wait_until(lambda: bridge.row(way, "/topic").get("messages"), "the first has passed")
    expired_s = time.monotonic() + 1
    wait_until(lambda: time.monotonic() > expired_s, "it has expired")
    hearer = target(hear, {"latched": True})
    assert int(hearer.wait_for(r"^heard (\d+)$").group(1)) > 0
