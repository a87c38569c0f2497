# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""A bridge killed at work forwards each message once or not at all; a latched one at least once."""

from __future__ import annotations

import os
import random
import signal
from itertools import pairwise
from typing import Any

import pytest

from rmw_manycore_bridge.counters import CounterFile, status_path
from rmw_manycore_py.native import _transport
from rmw_manycore_py.routes.route import DIRECTIONS
from support import IS_MANYCORE, TIMEOUT_S, wait_until
from support.nodes.ros import announce, peer_node, spin_until, type_of
from support.nodes.speakers import qos

pytestmark = [
    pytest.mark.integration,
    pytest.mark.skipif(not IS_MANYCORE, reason="the bridge is part of rmw_manycore"),
]

STRING = "std_msgs/msg/String"
EMPTY_STRING = bytes([0, 1, 0, 0, 1, 0, 0, 0, 0])  # in CDR
DEPTH = 10
PASSED = 5  # with one more, still fewer than the history depth for the bridge
KILLS = 3
# A publisher outside may go on writing to the place of a killed process until its lease is over.
LEASES_S = 4 * TIMEOUT_S
LATCHED = {"durability": "transient_local", "depth": DEPTH}
LAST = 200
ALL_LATCHED = {"durability": "transient_local", "depth": LAST}


def count_up(topic: str, words: dict[str, Any], period_s: float, last: int) -> None:
    """Publish numbers up to the last one, then keep the publisher."""
    with peer_node("counter") as node:
        publisher = node.create_publisher(type_of(STRING), topic, qos(words))
        number = 0

        def publish() -> None:
            nonlocal number
            if number < last:
                number += 1
                publisher.publish(type_of(STRING)(data=str(number)))
                if number == last:
                    announce("counted")

        node.create_timer(period_s, publish)
        spin_until(node, lambda: False, 1e6)


def show_numbers(topic: str, words: dict[str, Any]) -> None:
    """Print each message received."""
    with peer_node("viewer") as node:
        node.create_subscription(
            type_of(STRING), topic, lambda message: announce(f"heard {message.data}"), qos(words)
        )
        announce("listening")
        spin_until(node, lambda: False, 1e6)


def heard(viewer) -> list[int]:
    return [int(line.split()[1]) for line in viewer.lines if line.startswith("heard ")]


def sides(bridge, direction):
    """Return the functions that start a node on the source side and on the target side."""
    both = (bridge.inside, bridge.outside)
    return both if direction == "outward" else both[::-1]


def routes(bridge, direction, by_pattern):
    name = "/num*" if by_pattern else "/numbers"
    return bridge.pattern(direction, name) if by_pattern else bridge.route(direction, name)


@pytest.mark.parametrize("direction", DIRECTIONS)
def test_a_killed_bridge_does_not_go_back(bridge, direction) -> None:
    source, target = sides(bridge, direction)
    words = {"depth": DEPTH}
    viewer = target(show_numbers, "/numbers", words)
    source(count_up, "/numbers", words, 0.002, 1_000_000)
    for _ in range(KILLS):
        process = bridge.run(bridge.route(direction, "/numbers"))[direction]
        viewer.skip_output()
        for _ in range(random.randrange(1, 200)):
            viewer.wait_for("^heard", LEASES_S)
        os.kill(process.pid, signal.SIGKILL)
        process.wait()
    numbers = heard(viewer)
    assert numbers == sorted(set(numbers))


def test_what_a_killed_process_has_passed_on_is_dropped_and_counted(bridge) -> None:
    """The counters say before the bridge starts that the first messages have crossed."""
    route = bridge.route("outward", "/numbers")
    bridge.outside(show_numbers, "/numbers", {}).wait_for("^listening$")
    with _transport.Process(bridge.platform, 1, None, "source") as source:
        publisher = source.publisher("/numbers", STRING, _transport.Qos())
        before = CounterFile.create(status_path(bridge.platform, "outward", 0), [route])
        before.rows[0].note_last(publisher.gid, PASSED)
        before.close()
        bridge.run(route)
        wait_until(publisher.matched, "the bridge listens")
        for _ in range(PASSED + 1):
            publisher.publish(EMPTY_STRING)
        wait_until(lambda: bridge.row("outward", "/numbers")["messages"], "the last one crosses")
    row = bridge.row("outward", "/numbers")
    assert (row["messages"], row["repeated"]) == (1, PASSED)


def test_a_latched_message_that_was_noted_and_never_sent_is_passed_on(bridge) -> None:
    """As by a process that was killed between the two: its successor cannot tell."""
    route = bridge.route("outward", "/numbers")
    viewer = bridge.outside(show_numbers, "/numbers", LATCHED)
    viewer.wait_for("^listening$")
    with _transport.Process(bridge.platform, 1, None, "source") as source:
        latched = _transport.Qos(durability="transient_local", depth=DEPTH)
        publisher = source.publisher("/numbers", STRING, latched)
        before = CounterFile.create(status_path(bridge.platform, "outward", 0), [route])
        before.rows[0].note_last(publisher.gid, PASSED)
        before.close()
        for _ in range(PASSED):
            publisher.publish(EMPTY_STRING)
        bridge.run(route)
        for _ in range(PASSED):
            viewer.wait_for("^heard")
    row = bridge.row("outward", "/numbers")
    assert (row["messages"], row["repeated"]) == (PASSED, PASSED)


@pytest.mark.parametrize("direction", DIRECTIONS)
def test_kills_lose_no_latched_message(bridge, direction) -> None:
    """Each number is heard once, and at most once more after each kill, in order."""
    source, target = sides(bridge, direction)
    route = bridge.route(direction, "/numbers")
    viewer = target(show_numbers, "/numbers", ALL_LATCHED)
    viewer.wait_for("^listening$")
    source(count_up, "/numbers", ALL_LATCHED, 0.02, LAST)
    for _ in range(KILLS):
        process = bridge.run(route)[direction]
        viewer.skip_output()
        for _ in range(random.randrange(1, LAST // 2)):
            viewer.wait_for("^heard", LEASES_S)
        os.kill(process.pid, signal.SIGKILL)
        process.wait()
    bridge.run(route)
    everything = set(range(1, LAST + 1))
    wait_until(lambda: set(heard(viewer)) == everything, "all are heard", LEASES_S)
    numbers = heard(viewer)
    assert max(map(numbers.count, everything)) <= KILLS + 1
    steps_back = sum(after <= before for before, after in pairwise(numbers))
    assert steps_back <= KILLS


@pytest.mark.parametrize("by_pattern", [False, True])
@pytest.mark.parametrize("direction", DIRECTIONS)
def test_what_is_latched_comes_again_and_is_counted(bridge, direction, by_pattern) -> None:
    source, target = sides(bridge, direction)
    source(count_up, "/numbers", LATCHED, 0.002, 2 * DEPTH).wait_for("^counted$")
    viewer = target(show_numbers, "/numbers", LATCHED)
    viewer.wait_for("^listening$")  # late it would hear what the bridge keeps: the last one
    route = routes(bridge, direction, by_pattern)
    first = bridge.run(route)[direction]
    viewer.wait_for(f"^heard {2 * DEPTH}$")
    assert bridge.row(direction, "/numbers")["repeated"] == 0
    os.kill(first.pid, signal.SIGKILL)
    first.wait()
    viewer.skip_output()
    second = bridge.run(route)[direction]
    viewer.wait_for(f"^heard {2 * DEPTH}$")

    def all_counted() -> bool:
        row = bridge.row(direction, "/numbers")
        return row.get("pid") == second.pid and row["messages"] == DEPTH

    wait_until(all_counted, "the second process counts")
    assert bridge.row(direction, "/numbers")["repeated"] == DEPTH
    late = target(show_numbers, "/numbers", LATCHED)
    late.wait_for(f"^heard {2 * DEPTH}$")  # the reason why it is forwarded again
    assert len(heard(viewer)) == 2 * DEPTH  # no more often than counted
