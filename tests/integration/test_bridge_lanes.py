# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""Topics move between the lanes of a running bridge without losing a message."""

from __future__ import annotations

import array
import os
import signal

import pytest

from support import IS_MANYCORE, TIMEOUT_S, wait_until
from support.nodes.bridging import Bridge
from support.nodes.ros import announce, peer_node, spin_until, type_of

pytestmark = [
    pytest.mark.integration,
    pytest.mark.skipif(not IS_MANYCORE, reason="the bridge is part of rmw_manycore"),
]

HEAVY, LIGHT = ("/heavy_1", "/heavy_2"), ("/light_1", "/light_2")
TOPICS = [name for pair in zip(HEAVY, LIGHT, strict=True) for name in pair]  # both heavy in lane 0
DEPTH = 2000
MOVE_S = 3 * TIMEOUT_S  # a move that failed is tried again after a minute


def count_up() -> None:
    """Publish numbers forever, many and large ones on the heavy topics."""
    with peer_node("counter") as node:
        message = type_of("std_msgs/msg/UInt8MultiArray")

        def counter(topic: str) -> object:
            publisher = node.create_publisher(type(message()), topic, DEPTH)
            numbers = iter(range(2**31))
            counted = message(data=array.array("B", bytes(60_000 if topic in HEAVY else 10)))

            def publish() -> None:
                counted.layout.data_offset = next(numbers)
                publisher.publish(counted)

            return publish

        for topic in TOPICS:
            node.create_timer(0.006 if topic in HEAVY else 0.5, counter(topic))
        announce("counting")
        spin_until(node, lambda: False, 1e6)


def check_numbers() -> None:
    """Print every hundredth number of a topic, and each that is not the successor of the last."""
    with peer_node("checker") as node:
        message = type_of("std_msgs/msg/UInt8MultiArray")

        def checker(topic: str) -> object:
            last: list[int] = []

            def check(found: object) -> None:
                number = found.layout.data_offset  # type: ignore[attr-defined]
                if last and number != last[0] + 1:
                    announce(f"wrong {topic} {last[0]} {number}")
                last[:] = [number]
                if number % 100 == 0:
                    announce(f"{topic} {number}")

            return check

        for topic in TOPICS:
            node.create_subscription(message, topic, checker(topic), DEPTH)
        announce("checking")
        spin_until(node, lambda: False, 1e6)


def lanes_of(bridge: Bridge, way: str) -> list[int]:
    return [bridge.row(way, name)["lane"] for name in HEAVY]


@pytest.mark.parametrize("way", ["inward", "outward"])
def test_heavy_topics_end_up_in_different_lanes(bridge, way) -> None:
    routes = [bridge.route(way, name, "std_msgs/msg/UInt8MultiArray") for name in TOPICS]
    lanes = bridge.run_lanes(2, way, *routes)
    source, target = bridge.outside, bridge.inside
    if way == "outward":
        source, target = target, source
    checker = target(check_numbers)
    source(count_up)
    for name in HEAVY:
        checker.wait_for(f"^{name} ")
    lanes[0].wait_for(r"^/heavy_\d: moves to lane 1$", MOVE_S)
    wait_until(lambda: sorted(lanes_of(bridge, way)) == [0, 1], "the heavy are apart", MOVE_S)
    checker.skip_output()
    for name in (*HEAVY, *HEAVY):  # both go on
        checker.wait_for(f"^{name} ")
    assert [line for line in checker.lines if line.startswith("wrong")] == []
    for name in TOPICS:
        row = bridge.row(way, name)
        assert row["lost"] == row["refused"] == 0


def test_a_killed_lane_comes_back_to_its_topics(bridge) -> None:
    routes = [bridge.route("outward", name, "std_msgs/msg/UInt8MultiArray") for name in TOPICS]
    plan_lanes = bridge.run_lanes(2, "outward", *routes)
    checker = bridge.outside(check_numbers)
    bridge.inside(count_up)
    plan_lanes[0].wait_for("moves to lane 1$", MOVE_S)
    wait_until(lambda: sorted(lanes_of(bridge, "outward")) == [0, 1], "apart", MOVE_S)
    moved = HEAVY[lanes_of(bridge, "outward").index(1)]
    os.kill(bridge.row("outward", moved)["pid"], signal.SIGKILL)
    wait_until(lambda: not bridge.row("outward", moved)["alive"], "the lane is dead")
    bridge.run_lanes(2, "outward", *routes)[0].stop()
    checker.skip_output()
    checker.wait_for(f"^{moved} ")
    assert bridge.row("outward", moved)["lane"] == 1
