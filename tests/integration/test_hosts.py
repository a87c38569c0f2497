# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""One mapfile over hosts, here platforms of one machine."""

from __future__ import annotations

import json
import os
import re
import shutil
import signal
import socket
from collections.abc import Callable, Iterator
from pathlib import Path
from xml.etree import ElementTree

import pytest

from rmw_manycore_bridge.outside.types import hash_of
from rmw_manycore_py.ros.ament import package_prefix
from support import IS_MANYCORE, wait_until
from support.nodes.parted import HEARD, HOSTS, Parted
from support.nodes.serving import call, count, send_goal, serve
from support.nodes.speakers import (
    STRING,
    answer,
    count_among_newcomers,
    count_as_many,
    flood_by_answers,
    hear,
    hear_counters,
    hear_gids,
    say,
    say_as,
    say_as_many,
    say_stamped,
)
from support.nodes.zenoh_peers import free_port, locator
from support.peers.programs import forked_manycore
from support.processes.background import background_runs
from support.processes.platforms import leftovers
from support.processes.program import Program

pytestmark = [
    pytest.mark.integration,
    pytest.mark.needs("zenoh", "xxhash"),
    pytest.mark.skipif(not IS_MANYCORE, reason="hosts are part of rmw_manycore"),
]

OTHER_HASH = "RIHS01_" + "5" * 64
LATCHED = {"durability": "transient_local", "depth": 2}


@pytest.fixture
def platforms() -> Iterator[list[str]]:
    """Names of platforms that leave nothing, once `start` has ended their programs."""
    names: list[str] = []
    yield names
    for name in names:
        wait_until(lambda name=name: not leftovers(name), f"{name} leaves nothing in /dev/shm")


@pytest.fixture
def manycore(start, platform: str) -> Iterator[Callable[..., Program]]:
    with background_runs(start, platform) as call:
        yield call


@pytest.fixture
def hosts(platforms, start, tmp_path) -> Parted:
    made = Parted(start, tmp_path, {host: locator(free_port()) for host in HOSTS})
    platforms += made.platforms.values()
    return made


def test_topics_between_hosts(hosts) -> None:
    runs = hosts.run_all()
    assert "talker" not in runs["b"].output
    assert hosts.row("a", "outward", "/chatter")["lost"] == 0
    assert hosts.row("b", "inward", "/chatter")["lost"] == 0
    for run in runs.values():
        assert run.stop() == 0


def test_what_no_host_takes_does_not_cross(hosts) -> None:
    hosts.run_all()
    hosts.node("a", say, "/untaken", {}, 0.02).wait_for("^said$")
    wait_until(lambda: hosts.row("b", "inward", "/untaken"), "the other host knows of it")
    row = hosts.row("a", "outward", "/untaken")
    assert (row["messages"], row["state"]) == (0, "ready")
    hosts.node("b", hear, "/untaken", {}).wait_for("^heard again")


def test_a_late_subscriber_gets_what_was_latched_on_another_host(hosts) -> None:
    hosts.run_all()
    hosts.node("a", say, "/map", LATCHED, None, "older", "old", "new").wait_for("^said$")
    late = hosts.node("b", hear, "/map", LATCHED)
    late.wait_for("^heard old")
    late.wait_for("^heard new")


def test_services_and_actions_between_hosts(hosts) -> None:
    hosts.run_all()
    hosts.node("b", serve, True)
    caller = hosts.node("a", call, 2)
    for expected in ("True", "False"):
        caller.wait_for(f"^answer {expected} served$")
    counter, sender = hosts.node("a", count), hosts.node("b", send_goal)
    sender.wait_for(r"^feedback \[0, 1\]$")
    counter.signal(signal.SIGUSR1)
    sender.wait_for(r"^status 4 \[0, 1, 1\]$")  # succeeded

    def calls() -> int:
        return hosts.row("a", "outward", "/lamp", "service")["messages"]

    wait_until(lambda: calls() == 2, "both are counted")  # once their responses are sent


def test_a_host_that_goes_away_and_comes_back(hosts) -> None:
    runs = hosts.run_all()
    runs["a"].kill()
    runs["b"].wait_for(r"hosts inward.* lost host a; connecting again")
    wait_until(lambda: hosts.row("b", "inward", "/chatter")["state"] == "waiting", "it is gone")
    runs["b"].skip_output()
    hosts.run("a")
    runs["b"].wait_for(HEARD)


def test_a_host_that_the_mapfile_lacks(hosts, start) -> None:
    run = start(forked_manycore("run", hosts.mapfile, "--host", "c"))
    run.wait_for("--host: no host 'c' in .*; it has a, b")


def test_a_background_run_of_another_host(hosts, manycore) -> None:
    """Its mapfile is the same, and what the commands advise is about this host."""
    run = f"manycore up -d {hosts.mapfile} --host a"
    manycore("up", "-d", hosts.mapfile, "--host", "a")
    for words, part in (((), "the whole"), (("--host", "b"), "the part of host 'b'")):
        refused = manycore("up", "-d", hosts.mapfile, *words, status=2)
        assert f"runs the part of host 'a' of {hosts.mapfile}, not {part}" in refused.output
    assert "runs already" in manycore("up", "-d", hosts.mapfile, "--host", "a").output
    assert f"`{run}` moves talker back" in manycore("move", "talker", "1:5").output
    text = hosts.mapfile.read_text()
    hosts.mapfile.write_text(text.replace("talker: {cluster: 1,", "talker: {cluster: 1, core: 6,"))
    assert f"`{run}` applies it" in manycore("restart", "talker").output
    manycore("stop")
    assert f"`{run}` starts it again" in manycore("restart", "talker", status=1).output


def test_an_address_that_is_not_free_yet(hosts) -> None:
    port = int(hosts.addresses["b"].rpartition(":")[2])
    with socket.create_server(("127.0.0.1", port)):
        runs = {host: hosts.run(host) for host in HOSTS}
        runs["b"].wait_for("cannot listen at tcp/.*, the address of b: .*; trying again")
    runs["b"].wait_for(HEARD)
    assert runs["b"].output.count("(hosts inward) started") == 1
    assert runs["b"].stop() == 0


def test_a_host_that_does_not_read_costs_only_its_own_messages(platforms, start, tmp_path) -> None:
    hosts = Parted(start, tmp_path, {host: locator(free_port()) for host in (*HOSTS, "c")})
    platforms += hosts.platforms.values()
    hosts.run_all()
    hosts.node("c", hear, "/much", {})
    answerer = hosts.node("b", answer, "/much", "/heard", 100)
    flooder = hosts.node("a", flood_by_answers, "/much", "/heard", 100, 2)
    flooder.wait_for("^ready$")
    wait_until(lambda: hosts.row("c", "inward", "/much"), "the topic crosses")
    reader = hosts.row("c", "inward", "/much")["pid"]
    os.kill(reader, signal.SIGSTOP)
    try:
        flooder.signal(signal.SIGUSR1)
        wait_until(lambda: hosts.row("a", "outward", "/much", peer="c").get("lost"), "losses")
        answerer.skip_output()
        answerer.wait_for("^answered$")
        assert hosts.row("a", "outward", "/much", peer="b")["lost"] == 0
    finally:
        os.kill(reader, signal.SIGCONT)


def test_nodes_and_publishers_of_other_hosts(hosts) -> None:
    """They have their names, QoS and gids there, and messages the gid of their publisher."""
    hosts.run_all()
    for name, words in (("one", {}), ("two", LATCHED)):
        hosts.node("a", say_as, name, "/told", words).wait_for("^said$")
    hosts.node("b", hear_gids, "/told", 2).wait_for("^heard one and two from their gids$")

    def lines(*words: str) -> list[str]:
        return [line.strip() for line in hosts.command("b", *words).splitlines()]

    assert lines("node", "list") == ["/listener", "/one", "/talker", "/two"]
    assert hosts.gids("b", "/told") == hosts.gids("a", "/told")
    told = lines("topic", "info", "-v", "/told")
    assert {"Node name: one", "Node name: two"} <= {*told}
    assert told.count("Durability: TRANSIENT_LOCAL") == 1
    assert lines("node", "info", "/talker")[0] == "/talker"


def test_commands_show_both_hosts(hosts, tmp_path) -> None:
    """On each one: what nodes there are, their load, their picture, and what they publish."""
    hosts.run_all()
    names = {"/talker", "/listener"}

    def has_both(host: str) -> bool:
        return names == {*hosts.command(host, "node", "list").split()}

    for host in HOSTS:
        wait_until(lambda host=host: has_both(host), "the nodes of both are there")
        picture = tmp_path / f"{host}.svg"
        hosts.command(host, "view", "--once", "-o", str(picture))
        drawn = "".join(ElementTree.parse(picture).getroot().itertext())
        load = json.loads(hosts.command(host, "top", "--count", "1", "--json"))
        assert names <= {node["node"] for node in load["nodes"]}
        shown = hosts.command(host, "status", "--platform", hosts.platforms[host])
        for name in names:
            assert name in drawn
            assert name in shown
        assert "/chatter" in drawn
        assert "/chatter" in hosts.command(host, "topic", "list").split()
        assert "Hello World" in hosts.command(host, "topic", "echo", "--once", "/chatter")
        assert "/talker/get_parameters" in hosts.command(host, "service", "list").split()
    for verb, line in (("hz", "average rate: "), ("bw", "B/s from ")):
        hosts.tool("b", "topic", verb, "/chatter").wait_for(line)
    echo = hosts.tool("a", "topic", "echo", "--once", "/said", STRING)
    hosts.command("b", "topic", "pub", "--once", "/said", STRING, "data: there")
    echo.wait_for("^data: there$")


def another_definition(directory: Path) -> str:
    """Return a prefix of packages in which std_msgs/msg/String has another hash."""
    prefix = package_prefix("std_msgs")
    assert prefix is not None
    shutil.copytree(prefix / "share/std_msgs/msg", directory / "share/std_msgs/msg")
    entry = directory / "share/ament_index/resource_index/packages/std_msgs"
    entry.parent.mkdir(parents=True)
    entry.touch()
    file = directory / "share/std_msgs/msg/String.json"
    file.write_text(file.read_text().replace(hash_of(STRING), OTHER_HASH))
    return f"{directory}:{prefix}"


def test_a_type_of_another_definition_on_a_host(hosts, tmp_path) -> None:
    """Its topics do not cross; each side names the hash of the other. All else crosses."""
    told = {"a": OTHER_HASH, "b": hash_of(STRING)}
    runs = {"a": hosts.run("a")}
    runs["b"] = hosts.run("b", AMENT_PREFIX_PATH=another_definition(tmp_path / "other"))
    for run in runs.values():
        run.wait_for("connected to another host")
    hosts.node("a", serve, True)
    hosts.node("b", call, 1).wait_for("^answer True served$")
    hosts.node("b", say_as, "two", "/told", {})
    hosts.node("a", hear, "/told", {}).wait_for("^listening$")
    for host, topic in (("a", "/told"), ("b", "/chatter")):
        reason = f"is {STRING} of another definition ({told[host][:19]}..) outside, not {STRING}"
        runs[host].wait_for(re.escape(f"{topic}: {reason}"))
        row = hosts.row(host, "inward", topic)
        assert (row["state"], row["reason"], row["messages"]) == ("failed", reason, 0)
    assert hosts.row("a", "outward", "/chatter")["messages"] == 0
    assert "I heard" not in runs["b"].output


def test_many_publishers_of_a_topic(hosts) -> None:
    """Not even the first messages of one have the gid of another."""
    hosts.run_all()
    hosts.node("a", say_as, "one", "/told", {}).wait_for("^said$")
    hearer = hosts.node("b", hear_gids, "/told", 101)
    hearer.wait_for("^listening$")
    hosts.node("a", say_as_many, 100, "/told").wait_for("^said$")
    hearer.wait_for("^heard one and voice0 and .* from their gids$")

    def staying(host: str) -> dict[str, bytes]:
        found = hosts.gids(host, "/told").items()
        return {name: gid for name, gid in found if name == "one" or name.startswith("voice")}

    assert staying("b") == staying("a")
    assert len(staying("a")) == 101


def test_what_is_lost_when_publishers_come_is_counted(hosts) -> None:
    """Each makes the queues of the links deeper, by other subscriptions."""
    hosts.run_all()
    hearer = hosts.node("b", hear_counters, "/counted", 1)
    hearer.wait_for("^listening$")
    counter = hosts.node("a", count_among_newcomers, 20, "/counted")
    hearer.wait_for("^heard all$")
    counter.wait_for("^all came$")
    hearer.signal(signal.SIGUSR1)
    missing, lost = map(int, hearer.wait_for(r"^missing (\d+) lost (\d+)$").groups())
    rows = hosts.row("a", "outward", "/counted"), hosts.row("b", "inward", "/counted")
    assert missing <= lost + sum(row["lost"] for row in rows)


def test_what_was_latched_crosses_once(hosts) -> None:
    """Also when another publisher of the topic comes."""
    hosts.run_all()
    hearer = hosts.node("b", hear, "/map", LATCHED)
    hosts.node("a", say, "/map", LATCHED, None, "old", "new")
    hearer.wait_for("^heard new")
    hosts.node("a", say, "/map", LATCHED, None, "more")
    hearer.wait_for("^heard more")
    hosts.node("a", say, "/map", LATCHED, None, "most")
    hearer.wait_for("^heard most")
    assert re.findall(r"^heard (\S+)", hearer.output, re.M) == ["old", "new", "more", "most"]


def test_a_topic_published_on_both_hosts(hosts) -> None:
    """A host passes on its own messages only."""
    hosts.run_all()
    for host, name in zip(HOSTS, ("one", "two"), strict=True):
        hosts.node(host, say_as, name, "/told", {}).wait_for("^said$")
        hosts.node(host, hear, "/told", {}).wait_for("^listening$")
    for host in HOSTS:
        hosts.node(host, hear_gids, "/told", 2).wait_for("^heard one and two from their gids$")
    for host in HOSTS:
        wait_until(lambda host=host: hosts.row(host, "outward", "/told")["own"], "not passed on")


def test_a_killed_link_process(hosts) -> None:
    """The runner starts it again; publishers keep their gids."""
    runs = hosts.run_all()
    before = hosts.gids("b", "/chatter")
    os.kill(hosts.row("a", "outward", "/chatter")["pid"], signal.SIGKILL)
    runs["a"].wait_for("connected to another host")
    runs["b"].skip_output()
    runs["b"].wait_for(HEARD)
    wait_until(lambda: hosts.gids("b", "/chatter") == before, "the publisher is there again")
    assert hosts.row("b", "inward", "/chatter")["repeated"] == 0


def test_a_killed_inward_process_with_many_publishers(hosts) -> None:
    """Nothing comes twice; what is missing is lost, and counted, but what was just passed on."""
    runs = hosts.run_all()
    hearer = hosts.node("b", hear_counters, "/counted", 40)
    hearer.wait_for("^listening$")
    hosts.node("a", count_as_many, 40, "/counted")
    hearer.wait_for("^heard all$")
    hearer.wait_for("^heard all$")
    rows = [hosts.row("a", "outward", "/counted"), hosts.row("b", "inward", "/counted")]
    runs["b"].skip_output()
    os.kill(rows[1]["pid"], signal.SIGKILL)
    runs["b"].wait_for("connected to another host")
    hearer.skip_output()
    for _ in range(2):
        hearer.wait_for("^heard all$")
    hearer.signal(signal.SIGUSR1)
    missing, lost = map(int, hearer.wait_for(r"^missing (\d+) lost (\d+)$").groups())
    rows.append(hosts.row("b", "inward", "/counted"))
    assert rows[-1]["pid"] != rows[1]["pid"]
    lost += sum(row["lost"] for row in rows[1:]) + hosts.row("a", "outward", "/counted")["lost"]
    assert 0 < missing <= lost + 1


def test_a_clock_that_differs(hosts) -> None:
    """Messages keep the stamps of their host, which are no latency here."""
    hosts.run_all()
    for topic, stamp_ns in (("/behind", 10**9), ("/ahead", 4 * 10**18)):
        hosts.node("a", say_stamped, topic, stamp_ns)
        hosts.node("b", hear, topic, {}).wait_for(f"^heard then {stamp_ns}$")
        row = hosts.row("b", "inward", topic)
        assert (row["lost"], row["refused"], row["latency_max_ns"]) == (0, 0, 0)
