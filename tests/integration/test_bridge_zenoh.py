# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""Topics through a bridge to rmw_zenoh, with a client of its protocol that is not ours."""

from __future__ import annotations

import re
import signal
from pathlib import Path
from typing import Any

import pytest

from rmw_manycore_bridge.outside.types import hash_of
from rmw_manycore_py.routes.plan import Plan
from support import IS_MANYCORE, wait_until
from support.nodes.bridging import STRING, ZenohBridge
from support.nodes.ros import announce, peer_node, spin_until, type_of
from support.nodes.speakers import count_up, flood, hear, qos, say
from support.nodes.zenoh_peers import (
    hear_latched,
    locator,
    put,
    put_latched,
    sdk_hear,
    sdk_list,
    sdk_say,
    token,
)
from support.peers.programs import forked_manycore

pytestmark = [
    pytest.mark.integration,
    pytest.mark.needs("zenoh", "zenoh_ros2_sdk", "xxhash"),
    pytest.mark.skipif(not IS_MANYCORE, reason="the bridge is part of rmw_manycore"),
]

MANY = 10_000
LATCHED = {"durability": "transient_local", "depth": 2}
STRING_KEY = "std_msgs::msg::dds_::String_"


@pytest.fixture
def zenoh(start, platform) -> ZenohBridge:
    return ZenohBridge(start, platform)


def key(zenoh: ZenohBridge, name: str, type_hash: str | None = None) -> str:
    return f"{zenoh.domain}/{name}/{STRING_KEY}/{type_hash or hash_of(STRING)}"


def count_inside(topic: str, until: int) -> None:
    """Print how many texts came, and how many different ones, once the last one has come."""
    with peer_node("counter") as node:
        texts: list[str] = []

        def heard(message: Any) -> None:
            texts.append(message.data)
            if message.data == f"number {until}":
                announce(f"counted {len(texts)} {len(set(texts))}")

        message_type = type_of(STRING)
        node.create_subscription(message_type, topic, heard, qos({"depth": MANY}))
        announce("listening")
        spin_until(node, lambda: False, 1e6)


def say_numbers(topic: str, count: int) -> None:
    """Publish that many numbers once there is a subscription."""
    with peer_node("speaker") as node:
        message = type_of(STRING)
        publisher = node.create_publisher(message, topic, qos({"depth": MANY}))
        spin_until(node, publisher.get_subscription_count)
        for number in range(count):
            publisher.publish(message(data=f"number {number}"))
        announce("said")
        spin_until(node, lambda: False, 1e6)


def test_topics_cross_both_ways_without_an_echo(zenoh) -> None:
    zenoh.run(zenoh.route("inward", "/chat"), zenoh.route("outward", "/chat"))
    inside, outside = zenoh.inside(hear, "/chat", {}), zenoh.outside(sdk_hear, "/chat")
    speaker = zenoh.outside(sdk_say, "/chat", None, 0.05)
    zenoh.inside(say, "/chat", {}, 0.05)
    assert speaker.wait_for(r"^hash (\S+)").group(1) == hash_of(STRING)
    for side in (inside, outside):
        side.wait_for(r"^heard number")
        side.wait_for(r"^heard again")
    wait_until(lambda: zenoh.row("inward", "/chat").get("own", 0) > 5, "own messages outside")
    wait_until(lambda: zenoh.row("outward", "/chat").get("own", 0) > 5, "own messages inside")
    for side in (inside, outside):
        texts = re.findall(r"^heard (number \d+|again \d+)", side.output, re.MULTILINE)
        assert len(texts) == len(set(texts))
    assert zenoh.row("inward", "/chat")["lost"] == zenoh.row("outward", "/chat")["lost"] == 0


def test_two_bridges_in_one_domain_make_no_echo(other_platform, zenoh) -> None:
    """Each passes on what the nodes of its own platform publish, and nothing twice."""
    there = zenoh.beside(other_platform)
    for side in (zenoh, there):
        side.run(side.route("inward", "/chat"), side.route("outward", "/chat"))
    hearers = [zenoh.inside(hear, "/chat", {}), there.inside(hear, "/chat", {})]
    hearers.append(zenoh.outside(sdk_hear, "/chat"))
    zenoh.inside(count_up, "/chat", {}, 0.05)
    there.inside(say, "/chat", {}, 0.05)
    for hearer in hearers:
        for text in (r"\d+", r"again \d+") * 10:
            hearer.wait_for(rf"^heard {text}")
        texts = re.findall(r"^heard (\d+|again \d+)", hearer.output, re.MULTILINE)
        assert len(texts) == len(set(texts))


def test_no_reliable_message_is_lost(zenoh) -> None:
    zenoh.run(zenoh.route("inward", "/in"), zenoh.route("outward", "/out"))
    inside = zenoh.inside(count_inside, "/in", MANY - 1)
    outside = zenoh.outside(sdk_hear, "/out", None, MANY - 1)
    for side in (inside, outside):
        side.wait_for("^listening$")
    zenoh.outside(sdk_say, "/in", MANY, 0)
    zenoh.inside(say_numbers, "/out", MANY)
    for side in (inside, outside):
        side.wait_for(f"^counted {MANY} {MANY}$")
    assert zenoh.row("inward", "/in")["lost"] == zenoh.row("outward", "/out")["lost"] == 0


def test_a_late_subscriber_outside_gets_what_was_latched(zenoh) -> None:
    zenoh.run(zenoh.route("outward", "/map"))
    zenoh.inside(say, "/map", LATCHED, None, "older", "old", "new").wait_for("^said$")
    wait_until(lambda: zenoh.row("outward", "/map").get("messages", 0) >= 2, "they have crossed")
    late = zenoh.outside_of_domain(hear_latched, key(zenoh, "map"), 2)
    late.wait_for("^heard old$")
    late.wait_for("^heard new$")


def test_a_late_subscriber_inside_gets_what_was_latched(zenoh) -> None:
    zenoh.outside_of_domain(put_latched, key(zenoh, "map"), "old", "new").wait_for("^said$")
    zenoh.run(zenoh.route("inward", "/map"))
    late = zenoh.inside(hear, "/map", LATCHED)
    late.wait_for("^heard old")
    late.wait_for("^heard new")
    zenoh.inside(hear, "/map", LATCHED).wait_for("^heard new")


def test_a_pattern_finds_topics(zenoh) -> None:
    zenoh.run(zenoh.pattern("inward", "/cam/*"), zenoh.pattern("outward", "/arm/*"))
    inside, outside = zenoh.inside(hear, "/cam/a", {}), zenoh.outside(sdk_hear, "/arm/b")
    zenoh.outside(sdk_say, "/cam/a", None, 0.05)
    zenoh.inside(say, "/arm/b", {}, 0.05)
    inside.wait_for("^heard number")
    outside.wait_for("^heard again")


def test_the_graph_shows_the_bridges_endpoints(zenoh) -> None:
    zenoh.run(zenoh.route("outward", "/chat"))
    watcher = zenoh.outside(sdk_list)
    watcher.wait_for(r"^topics \[\] services \[\]$")
    speaker = zenoh.inside(say, "/chat", {}, 0.05)
    watcher.wait_for(r"^topics \[\('/chat', \['std_msgs/msg/String'\]\)\] services \[\]$")
    speaker.stop()
    watcher.wait_for(r"^topics \[\] services \[\]$")


@pytest.mark.parametrize("attached", ["none", "new", "old"])
def test_a_publisher_without_a_token_is_heard(zenoh, attached) -> None:
    processes = zenoh.run(zenoh.route("inward", "/pico"))
    zenoh.outside_of_domain(put, key(zenoh, "pico"), attached, 0.05)
    hearer = zenoh.inside(hear, "/pico", {})
    hearer.wait_for("^heard number")
    said = {"none": "no attachment of rmw_zenoh", "old": "attachment of rmw_zenoh before 0.2.4"}
    if attached in said:
        processes["inward"].wait_for(f"^zenoh: pico: messages have .*{said[attached]}")
    hearer.stop()
    wait_until(lambda: zenoh.row("inward", "/pico")["state"] == "waiting", "it stops to listen")


def test_another_definition_of_a_type_is_reported(zenoh) -> None:
    other = "RIHS01_" + "5" * 64
    zenoh.run(zenoh.route("inward", "/chat"))
    text = f"@ros2_lv/{zenoh.domain}/a/0/1/MP/%/%/speaker/%chat/{STRING_KEY}/{other}/::,10:,:,:,,"
    zenoh.outside_of_domain(token, text).wait_for("^declared$")
    wait_until(lambda: zenoh.row("inward", "/chat").get("state") == "failed", "it is told")
    reason = f"is {STRING} of another definition (RIHS01_555555555555..) outside, not {STRING}"
    assert zenoh.row("inward", "/chat")["reason"] == reason


def test_newer_and_unknown_tokens(zenoh) -> None:
    processes = zenoh.run(zenoh.route("inward", "/chat"))
    begin = f"@ros2_lv/{zenoh.domain}/a/0/1"
    zenoh.outside_of_domain(token, f"{begin}/XX/%/%/speaker").wait_for("^declared$")
    processes["inward"].wait_for("^zenoh: unknown token in the graph: expected one of NN, MP")
    known = f"{begin}/MP/%/%/speaker/%chat/{STRING_KEY}/{hash_of(STRING)}/::,10:,:,:,,"
    zenoh.outside_of_domain(token, f"{known}/a_part_more").wait_for("^declared$")
    wait_until(lambda: zenoh.row("inward", "/chat")["state"] == "ready", "it is understood")


def test_a_router_that_is_killed_and_comes_back(zenoh) -> None:
    processes = zenoh.run(zenoh.route("inward", "/chat"))
    hearer = zenoh.inside(hear, "/chat", {})
    zenoh.outside(sdk_say, "/chat", None, 0.05)
    hearer.wait_for("^heard number")
    zenoh.router.kill()
    processes["inward"].wait_for(r"^zenoh: the router at tcp/\S+ is gone; connecting again")
    zenoh.start_router()
    processes["inward"].wait_for(r"^zenoh: connected to the router at tcp/")
    hearer.skip_output()
    hearer.wait_for("^heard number")


def test_a_killed_peer_is_reported(zenoh) -> None:
    processes = zenoh.run(zenoh.route("inward", "/chat"))
    hearer = zenoh.inside(hear, "/chat", {})
    speaker = zenoh.outside(sdk_say, "/chat", None, 0.05)
    hearer.wait_for("^heard number")
    speaker.kill()
    processes["inward"].wait_for("^zenoh: lost the peer with /speaker$")
    wait_until(lambda: zenoh.row("inward", "/chat")["state"] == "waiting", "its publisher is gone")


def test_a_process_comes_up_before_its_router(zenoh) -> None:
    zenoh.router.kill()
    processes = zenoh.run(zenoh.route("outward", "/chat"))
    processes["outward"].wait_for(r"^zenoh: no zenoh router at tcp/\S+: nothing crosses before")
    zenoh.inside(say, "/chat", {}, 0.05)
    zenoh.start_router()
    zenoh.outside(sdk_hear, "/chat").wait_for("^heard again")


def test_a_peer_that_does_not_read_costs_counted_messages(zenoh) -> None:
    """The bridge waits for the peer; what overflows meanwhile is lost, and counted."""
    zenoh.run(zenoh.route("outward", "/much"))
    hearer = zenoh.outside(sdk_hear, "/much")
    speaker = zenoh.inside(flood, "/much")
    hearer.wait_for("^heard x")
    hearer.signal(signal.SIGSTOP)
    wait_until(lambda: zenoh.row("outward", "/much")["lost"], "losses are counted")
    hearer.signal(signal.SIGCONT)
    hearer.skip_output()
    hearer.wait_for("^heard x")
    assert speaker.is_running()


def test_a_gateway_between_dds_and_rmw_zenoh(zenoh, bridge, manycore) -> None:
    """Both bridges of one platform: nodes of either outside hear those of the other."""
    bridge.run(bridge.route("inward", "/from_dds"), bridge.route("outward", "/from_zenoh"))
    zenoh.run(zenoh.route("outward", "/from_dds"), zenoh.route("inward", "/from_zenoh"))
    on_zenoh, on_dds = zenoh.outside(sdk_hear, "/from_dds"), bridge.outside(hear, "/from_zenoh", {})
    bridge.outside(say, "/from_dds", {}, 0.05)
    zenoh.outside(sdk_say, "/from_zenoh", None, 0.05)
    on_zenoh.wait_for("^heard again")
    on_dds.wait_for("^heard number")
    engines = {row["engine"] for row in zenoh.rows()}
    assert engines == {"fastdds", "zenoh"}
    assert f"zenoh {zenoh.domain}" in manycore("bridge", "status")


MAPFILE = """
platform: {{clusters: 1, cores_per_cluster: 8}}
bridge: {{domain: {domain}, outside: {{engine: zenoh, connect: [{connect}]}}}}
nodes:
  talker:
    cluster: 1
    module: rmw_manycore_py.examples.talker
    topic_to: {{/chatter: std_msgs/msg/String}}
"""
BRIDGE_FILE = """
from_domain: 99
to_domain: {domain}
outside: {{engine: zenoh, mode: rmw_zenoh, connect: [{connect}]}}
topics:
  chatter: {{type: std_msgs/msg/String}}
"""


def test_a_mapfile_names_the_engine(zenoh, start, tmp_path) -> None:
    mapfile = tmp_path / "zenoh.yaml"
    mapfile.write_text(MAPFILE.format(domain=zenoh.domain, connect=locator(zenoh.port)))
    run = start(forked_manycore("run", mapfile))
    zenoh.outside(sdk_hear, "/chatter").wait_for("^heard Hello World")
    assert run.stop() == 0


def test_a_bridge_file_names_the_engine(zenoh, start, tmp_path) -> None:
    file = tmp_path / "zenoh.yaml"
    file.write_text(BRIDGE_FILE.format(domain=zenoh.domain, connect=locator(zenoh.port)))
    zenoh.inside(say, "/chatter", {}, 0.05).wait_for("^said$")
    run = start(forked_manycore("bridge", file, "--inside", "99"))
    zenoh.outside(sdk_hear, "/chatter").wait_for("^heard again")
    assert run.stop() == 0


def test_the_process_loads_no_ros(zenoh) -> None:
    plan = Plan(zenoh.platform, (zenoh.route("outward", "/chat"),), zenoh.settings)
    process = zenoh.run_unforked(plan, "outward")
    zenoh.inside(say, "/chat", {}, 0.05)
    zenoh.outside(sdk_hear, "/chat").wait_for("^heard again")
    loaded = Path(f"/proc/{process.pid}/maps").read_text()
    assert "zenoh" in loaded
    assert not re.search("rclpy|fastrtps|numpy", loaded)
