# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""Topics that match a pattern are forwarded as they appear, between real nodes on both sides."""

from __future__ import annotations

import os
import signal

import pytest

from rmw_manycore_bridge.status import status
from rmw_manycore_py.native import _transport
from rmw_manycore_py.routes.route import DIRECTIONS, Direction
from support import IS_MANYCORE, wait_until
from support.nodes.bridging import OUTSIDE, STRING, Bridge
from support.nodes.ros import announce, peer_node, spin_until, type_of
from support.nodes.speakers import hear, say
from support.peers.programs import forked_example, forked_manycore
from support.processes.domains import domain_of

pytestmark = [
    pytest.mark.integration,
    pytest.mark.skipif(not IS_MANYCORE, reason="the bridge is part of rmw_manycore"),
]

AGAIN = "^heard again"
BOOL = "std_msgs/msg/Bool"
MISSING = "no_such_msgs/msg/Text"


def say_true(topic: str) -> None:
    """Publish a Bool periodically."""
    with peer_node("other_speaker") as node:
        publisher = node.create_publisher(type_of(BOOL), topic, 10)
        node.create_timer(0.05, lambda: publisher.publish(type_of(BOOL)(data=True)))
        announce("saying")
        spin_until(node, lambda: False, 1e6)


def names(bridge: Bridge, direction: Direction) -> set[str]:
    """Return the inside names of the routes of a direction."""
    return {r["inside"] for r in status(bridge.platform) if r["direction"] == direction}


def crossed(bridge: Bridge, direction: Direction) -> set[str]:
    """Return the inside names of the routes that have forwarded a message."""
    rows = [r for r in status(bridge.platform) if r["direction"] == direction]
    return {r["inside"] for r in rows if r["messages"] > 0}


def wait_for_state(bridge: Bridge, direction: Direction, name: str, state: str) -> None:
    wait_until(lambda: bridge.row(direction, name).get("state") == state, f"{name} is {state}")


@pytest.mark.parametrize("direction", DIRECTIONS)
def test_topics_cross_as_they_appear(bridge, direction) -> None:
    bridge.run(bridge.pattern(direction, "/camera/*"))
    source, target = bridge.outside, bridge.inside
    if direction == "outward":
        source, target = target, source
    hearers = [target(hear, f"/camera/{side}", {}) for side in ("left", "right")]
    for hearer in hearers:
        hearer.wait_for("^listening$")
    wait_for_state(bridge, direction, "/camera/*", "waiting")
    source(say, "/camera/left", {}, 0.05)
    hearers[0].wait_for(AGAIN)
    source(say, "/camera/right", {}, 0.05)
    hearers[1].wait_for(AGAIN)
    assert names(bridge, direction) == {"/camera/*", "/camera/left", "/camera/right"}
    assert bridge.row(direction, "/camera/left")["type"] == STRING
    assert bridge.row(direction, "/camera/*")["reason"] == "topics: 2"


@pytest.mark.parametrize("direction", DIRECTIONS)
def test_a_topic_may_go_and_come_back(bridge, direction) -> None:
    bridge.run(bridge.pattern(direction, "/camera/*"))
    source, target = bridge.outside, bridge.inside
    if direction == "outward":
        source, target = target, source
    hearer = target(hear, "/camera/left", {})
    speaker = source(say, "/camera/left", {}, 0.05)
    hearer.wait_for(AGAIN)
    speaker.stop()
    wait_for_state(bridge, direction, "/camera/left", "waiting")
    wait_for_state(bridge, direction, "/camera/*", "waiting")
    hearer.skip_output()
    source(say, "/camera/left", {}, 0.05)
    hearer.wait_for(AGAIN)


def test_what_is_hidden_or_of_every_node_stays_where_it_is(bridge) -> None:
    bridge.run(bridge.pattern("outward", "/**"))
    for topic in ("/_hidden", "/camera/_hidden", "/camera/left/image"):
        bridge.inside(say, topic, {}, 0.05).wait_for("^said$")
    bridge.outside(hear, "/camera/left/image", {}).wait_for(AGAIN)
    assert names(bridge, "outward") == {"/**", "/camera/left/image"}  # /rosout and others do not


def test_names_have_the_prefix_outside(bridge) -> None:
    bridge.run(
        *(
            bridge.pattern(way, "/camera/*", outside="/robot/camera/*", prefix="/robot")
            for way in DIRECTIONS
        )
    )
    bridge.inside(say, "/camera/left", {}, 0.05)
    bridge.outside(hear, "/robot/camera/left", {}).wait_for(AGAIN)
    bridge.outside(say, "/robot/camera/right", {}, 0.05)
    bridge.inside(hear, "/camera/right", {}).wait_for(AGAIN)


def test_nothing_comes_back(bridge) -> None:
    bridge.run(bridge.pattern("inward", "/**"), bridge.pattern("outward", "/**"))
    hearers = [side(hear, "/chat", {"depth": 1000}) for side in (bridge.inside, bridge.outside)]
    bridge.inside(say, "/inside", {}, 0.05)
    bridge.outside(say, "/outside", {}, 0.05)
    for side in (bridge.inside, bridge.outside):
        side(say, "/chat", {"depth": 1000}, 0.05)
    bridge.inside(hear, "/outside", {}).wait_for(AGAIN)
    bridge.outside(hear, "/inside", {}).wait_for(AGAIN)
    for direction, topic in (("outward", "/inside"), ("inward", "/outside")):
        both = {topic, "/chat"}
        wait_until(lambda d=direction, b=both: crossed(bridge, d) >= b, f"{both} go {direction}")
    for hearer in hearers:
        for _ in range(40):
            hearer.wait_for(AGAIN)
        texts = [line.split()[2] for line in hearer.lines if line.startswith("heard again")]
        assert len(texts) == len(set(texts))
    assert crossed(bridge, "outward") == {"/inside", "/chat"}
    assert crossed(bridge, "inward") == {"/outside", "/chat"}


def test_a_topic_with_a_route_of_its_own_or_in_two_patterns_crosses_once(bridge) -> None:
    bridge.run(
        bridge.pattern("outward", "/camera/*"),
        bridge.pattern("outward", "/**"),
        bridge.route("outward", "/camera/left", outside="/left"),
    )
    bridge.inside(say, "/camera/left", {}, 0.05)
    bridge.inside(say, "/camera/right", {}, 0.05)
    bridge.outside(hear, "/left", {}).wait_for(AGAIN)
    bridge.outside(hear, "/camera/right", {}).wait_for(AGAIN)
    rows = sorted(r["inside"] for r in status(bridge.platform))
    assert rows == ["/**", "/camera/*", "/camera/left", "/camera/right"]


@pytest.mark.parametrize("direction", DIRECTIONS)
def test_a_topic_of_two_types_is_named_once_and_works_when_one_is_left(bridge, direction) -> None:
    process = bridge.run(bridge.pattern(direction, "/camera/*"))[direction]
    source, target = bridge.outside, bridge.inside
    if direction == "outward":
        source, target = target, source
    hearer = target(hear, "/camera/left", {})
    other = source(say_true, "/camera/left")
    other.wait_for("^saying$")
    source(say, "/camera/left", {}, 0.05)
    wait_for_state(bridge, direction, "/camera/left", "failed")
    reason = f"has several types, so it is not bridged: {BOOL}, {STRING}"
    assert bridge.row(direction, "/camera/left")["reason"] == reason
    process.wait_for(f"^/camera/left: {reason}$")
    other.stop()
    hearer.wait_for(AGAIN)
    assert process.output.count(reason) == 1


def test_a_type_that_is_not_installed_is_named_once_and_others_cross(bridge) -> None:
    process = bridge.run(bridge.pattern("outward", "/camera/*"))["outward"]
    with _transport.Process(bridge.platform, 1, None, "stranger") as stranger:
        publisher = stranger.publisher("/camera/odd", MISSING, _transport.Qos())
        wait_for_state(bridge, "outward", "/camera/odd", "failed")
        bridge.inside(say, "/camera/left", {}, 0.05)
        bridge.outside(hear, "/camera/left", {}).wait_for(AGAIN)
        reason = f"type {MISSING} is not installed: there is no package 'no_such_msgs' with it"
        assert bridge.row("outward", "/camera/odd")["reason"] == reason
        assert process.output.count(reason) == 1
        del publisher


def test_a_killed_process_leaves_no_topics_behind(bridge) -> None:
    route = bridge.pattern("outward", "/camera/*")
    process = bridge.run(route)["outward"]
    speaker = bridge.inside(say, "/camera/left", {}, 0.05)
    wait_until(lambda: bridge.row("outward", "/camera/left"), "the topic has a route")
    os.kill(process.pid, signal.SIGKILL)
    process.wait()
    speaker.stop()
    bridge.run(route)
    wait_until(lambda: bridge.row("outward", "/camera/*").get("alive"), "another one counts")
    assert names(bridge, "outward") == {"/camera/*"}


def test_a_mapfile_names_a_pattern(start, tmp_path, platform) -> None:
    mapfile = tmp_path / "map.yaml"
    mapfile.write_text(
        "bridge: {routes: {/chat*: {max_hz: 1000}}}\n"
        "nodes:\n"
        "  talker: {package: rmw_manycore, executable: talker, cluster: 1, topic_to: {chat*: }}\n"
    )
    run = start(forked_manycore("run", mapfile))
    start(forked_example("listener"), **OUTSIDE).wait_for("I heard: 'Hello World")
    assert run.stop() == 0


def test_a_bridge_file_names_a_pattern(start, tmp_path, platform) -> None:
    domain = domain_of(platform)
    config = tmp_path / "bridge.yaml"
    config.write_text(f"from_domain: {domain + 1}\nto_domain: {domain}\ntopics: {{chat*: }}\n")
    bridge = start(forked_manycore("bridge", config, "--inside", str(domain + 1)))
    start(forked_example("talker"))
    start(forked_example("listener"), **OUTSIDE).wait_for("I heard: 'Hello World")
    assert bridge.stop() == 0
