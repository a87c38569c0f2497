# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""Mapping by trying: a changed mapfile is applied to its run, and nodes are moved."""

from __future__ import annotations

import json
import os
import signal
import sys
from collections.abc import Callable, Iterator
from pathlib import Path
from typing import Any

import pytest

from rmw_manycore_py.errors import EXIT_BAD_INPUT
from rmw_manycore_py.launch.runs.client import Client
from rmw_manycore_py.launch.runs.directory import RunDirectory, runs_of
from support import IS_MANYCORE, wait_until
from support.processes.background import background_runs
from support.processes.commands import manycore_command
from support.processes.platforms import leftovers
from support.processes.program import Program

pytestmark = [
    pytest.mark.integration,
    pytest.mark.skipif(not IS_MANYCORE, reason="manycore up is about rmw_manycore"),
]

SLEEP = "command: [sleep, '1000'], ros_arguments: false"
ROUTES = "topic_in: {/scan: std_msgs/msg/String}"
# Ends once a file exists, after it was asked to.
SLOW = """
import pathlib, signal, sys, time
def end(*_):
    while not pathlib.Path(sys.argv[1]).exists():
        time.sleep(0.01)
    sys.exit()
signal.signal(signal.SIGINT, end)
signal.signal(signal.SIGTERM, lambda *_: None)
print("ready")
while True:
    signal.pause()
"""


@pytest.fixture
def manycore(start, platform: str) -> Iterator[Callable[..., Program]]:
    with background_runs(start, platform) as call:
        yield call


@pytest.fixture
def mapfile(tmp_path: Path) -> Path:
    return tmp_path / "map.yaml"


def write(mapfile: Path, head: str = "", **nodes: str) -> None:
    lines = [f"  {name}: {{{section}}}\n" for name, section in nodes.items()]
    mapfile.write_text(f"{head}nodes:\n{''.join(lines)}")


def slow(file: Path) -> str:
    return f"command: {json.dumps([sys.executable, '-uc', SLOW, str(file)])}, ros_arguments: false"


def nodes_of(manycore: Any, platform: str) -> dict[str, dict[str, Any]]:
    runs = json.loads(manycore("ps", "--platform", platform, "--json").output)
    return {node["name"]: node for run in runs for node in run["nodes"]}


def places(rows: dict[str, dict[str, Any]]) -> dict[str, tuple[int, int]]:
    return {name: (row["cluster"], row["core"]) for name, row in rows.items()}


def the_run(platform: str) -> RunDirectory:
    (run,) = runs_of(platform)
    return run


def test_what_changed_is_applied_and_the_rest_runs_on(manycore, mapfile, platform) -> None:
    talker = "cluster: 1, module: rmw_manycore_py.examples.talker"
    listener = "module: rmw_manycore_py.examples.listener"
    write(mapfile, talker=talker, listener=f"cluster: 2, {listener}", old=f"cluster: 1, {SLEEP}")
    manycore("up", "-d", mapfile)
    before = nodes_of(manycore, platform)
    write(
        mapfile,
        first=f"cluster: 1, {SLEEP}",
        talker=talker,
        listener=f"cluster: 3, core: 5, {listener}",
    )
    applied = manycore("up", "-d", mapfile).lines
    assert applied[:3] == [
        "manycore | listener changes: cluster 2 core 1 -> cluster 3 core 5",
        "manycore | first is new: cluster 1 core 2",
        "manycore | old is removed",
    ]
    after = nodes_of(manycore, platform)
    assert places(after) == {"talker": (1, 1), "listener": (3, 5), "first": (1, 2)}
    assert {row["state"] for row in after.values()} == {"running"}
    assert after["talker"]["pid"] == before["talker"]["pid"], "it keeps the core left open"
    assert after["listener"]["pid"] != before["listener"]["pid"]
    assert "unchanged" in manycore("up", "-d", mapfile).output
    assert nodes_of(manycore, platform) == after
    wait_until(lambda: (3, 5) in joined_cores(manycore, platform), "the listener has joined there")
    manycore("stop", "first")
    remark = "first is unchanged, and has ended: `manycore restart first`"
    assert remark in manycore("up", "-d", mapfile).output
    manycore("stop")
    assert leftovers(platform) == []


def joined_cores(manycore: Any, platform: str) -> set[tuple[int, int]]:
    (row,) = json.loads(manycore("status", "--platform", platform, "--json").output)
    return {(process["cluster"], process["core"]) for process in row["processes"]}


def test_a_definition_is_applied_with_its_parameters(manycore, mapfile, platform) -> None:
    talker = "cluster: 1, module: rmw_manycore_py.examples.talker"
    write(mapfile, talker=f"{talker}, parameters: {{rate_hz: 1.5}}", other=f"cluster: 1, {SLEEP}")
    manycore("up", "-d", mapfile)
    environment = "cluster: 1, env: {A: b}"
    write(
        mapfile,
        talker=f"{talker}, parameters: {{rate_hz: 2.5}}",
        other=f"{environment}, terminal: true, {SLEEP}",
    )
    applied = manycore("up", "-d", mapfile).output
    assert "talker changes: parameters" in applied
    assert "other changes: terminal, environment" in applied
    wait_until(lambda: "/talker" in manycore("node", "list").lines, "the talker is back")
    assert "2.5" in manycore("param", "get", "/talker", "rate_hz").output
    manycore("stop")


@pytest.fixture
def exchange(manycore, start, mapfile, tmp_path, platform) -> tuple[Program, Path]:
    """Let two nodes exchange their cores, of which one ends only when a file is there."""
    go = tmp_path / "go"
    places = ("cluster: 1, core: 1", "cluster: 1, core: 2")
    write(mapfile, slow=f"{places[0]}, {slow(go)}", quick=f"{places[1]}, {SLEEP}")
    manycore("up", "-d", mapfile)
    wait_until(lambda: "ready" in manycore("logs", "slow").output, "it handles signals")
    write(mapfile, slow=f"{places[1]}, {slow(go)}", quick=f"{places[0]}, {SLEEP}")
    up = start(manycore_command("up", "-d", mapfile))
    between = {"slow": "interrupted", "quick": "waiting"}
    wait_until(lambda: states(platform) == between, "one is stopped, and the other waits for it")
    return up, go


def states(platform: str) -> dict[str, str]:
    with Client(the_run(platform), "state") as client:
        return {node["name"]: node["state"] for node in client.answer["nodes"]}


def test_a_core_is_taken_once_it_is_left(manycore, exchange, platform) -> None:
    up, go = exchange
    go.touch()
    assert up.wait() == 0
    after = nodes_of(manycore, platform)
    assert places(after) == {"slow": (1, 2), "quick": (1, 1)}
    assert {row["state"] for row in after.values()} == {"running"}
    manycore("stop")


def test_a_supervisor_killed_between_the_steps(manycore, mapfile, exchange, platform) -> None:
    up, go = exchange
    with Client(the_run(platform), "state") as client:
        pids = [node["pid"] for node in client.answer["nodes"] if node["pid"]]
    os.kill(the_run(platform).info["pid"], signal.SIGKILL)
    assert up.wait() == 1
    assert f"the run of platform '{platform}' has ended" in up.output
    wait_until(lambda: not any(Path(f"/proc/{pid}").exists() for pid in pids), "its nodes are dead")
    go.touch()
    assert f"the run of {mapfile} was killed at" in manycore("ps").output
    assert "was killed at" in manycore("restart", status=1).output
    up = manycore("up", "-d", mapfile)
    assert "manycore | in the background: manycore logs -f; manycore stop" in up.lines
    assert places(nodes_of(manycore, platform)) == {"slow": (1, 2), "quick": (1, 1)}
    manycore("stop")
    assert leftovers(platform) == []


def test_a_stopped_supervisor_is_named_at_once(manycore, mapfile, platform) -> None:
    write(mapfile, one=f"cluster: 1, {SLEEP}")
    manycore("up", "-d", mapfile)
    pid = the_run(platform).info["pid"]
    os.kill(pid, signal.SIGSTOP)
    named = f"(pid {pid}) is stopped (SIGSTOP): `kill -CONT {pid}` lets it go on"
    for words in (("restart",), ("move", "one", "2"), ("up", "-d", mapfile), ("stop",)):
        assert named in manycore(*words, status=1).output
    assert named in manycore("ps").output
    os.kill(pid, signal.SIGCONT)
    manycore("stop")


def test_what_a_running_platform_keeps_is_refused(manycore, mapfile, platform) -> None:
    sleeper = f"cluster: 1, {SLEEP}"
    write(mapfile, "topics: {/scan: {topic_dsm_size: 65536}}\n", sleeper=sleeper)
    manycore("up", "-d", mapfile)
    before = nodes_of(manycore, platform)
    moved = f"cluster: 2, {SLEEP}"
    topics = "topics: {/scan: {topic_dsm_size: 65536}}\n"
    changes = {
        "the platform's shape has changed": ("platform: {clusters: 3}\n" + topics, moved),
        "the platform's name has changed": (f"platform: {{name: {platform}-2}}\n{topics}", moved),
        "the section 'topics' has changed": (topics.replace("65536", "131072"), moved),
        "the clock has changed": (f"clock: virtual\n{topics}", moved),
        "what is bridged has changed": (topics, f"{moved}, {ROUTES}"),
        "expected an installed Python module": (topics, "cluster: 1, module: no_such_module"),
    }
    for reason, (head, node) in changes.items():
        write(mapfile, head, sleeper=node)
        (line,) = manycore("up", "-d", mapfile, status=EXIT_BAD_INPUT).lines
        assert reason in line
        assert reason.startswith("expected") or f"then `manycore up -d {mapfile}`" in line
        assert nodes_of(manycore, platform) == before
    other = mapfile.with_name("other.yaml")
    write(other, sleeper=sleeper)
    assert "is running already" in manycore("up", "-d", other, status=1).output
    manycore("stop")


def test_a_mapfile_that_loses_its_platform_keeps_it(manycore, mapfile, platform) -> None:
    named = f"{platform}-named"
    write(mapfile, f"platform: {{name: {named}}}\n", sleeper=f"cluster: 1, {SLEEP}")
    manycore("up", "-d", mapfile)
    write(mapfile, sleeper=f"cluster: 1, {SLEEP}")
    text = manycore("up", "-d", mapfile, status=EXIT_BAD_INPUT).output
    assert "the platform's name has changed, which cannot be applied" in text
    assert f"`manycore stop --platform {named}`, then `manycore up -d {mapfile}`" in text
    manycore("stop", "--platform", named)
    assert leftovers(named) == []


def test_names_from_the_environment_are_two_platforms(
    start, manycore, mapfile, other_platform
) -> None:
    write(mapfile, sleeper=f"cluster: 1, {SLEEP}")
    manycore("up", "-d", mapfile)
    other = start(manycore_command("up", "-d", mapfile), MANYCORE_PLATFORM=other_platform)
    assert other.wait() == 0
    manycore("stop", "--platform", other_platform)
    manycore("stop")


def test_nodes_in_virtual_time_keep_their_places(manycore, mapfile, platform) -> None:
    talker = "module: rmw_manycore_py.examples.talker"
    write(mapfile, "clock: virtual\n", talker=f"cluster: 1, {talker}")
    manycore("up", "-d", mapfile)
    before = nodes_of(manycore, platform)
    for words in (("move", "talker", "2"), ("up", "-d", mapfile)):
        write(mapfile, "clock: virtual\n", talker=f"cluster: 2, {talker}")
        assert "the run is in virtual time" in manycore(*words, status=1).output
    assert nodes_of(manycore, platform) == before
    manycore("stop")


def test_a_restart_reports_the_place_it_keeps(manycore, mapfile, platform) -> None:
    write(mapfile, one=f"cluster: 1, {SLEEP}", two=f"cluster: 1, {SLEEP}")
    manycore("up", "-d", "--node", "one", mapfile)
    assert "notice" not in manycore("restart", "one").output, "two is no change"
    write(mapfile, one=f"cluster: 2, {SLEEP}", two=f"cluster: 1, {SLEEP}")
    differs = f"{mapfile} differs from what runs: one changes: cluster 1 core 1 -> cluster 2 core 1"
    assert f"{differs}; `manycore up -d {mapfile}` applies it" in manycore("restart").output
    assert places(nodes_of(manycore, platform)) == {"one": (1, 1)}
    mapfile.unlink()
    assert "nodes restart as their run read" in manycore("restart", "one").output
    manycore("stop")


def test_a_node_is_moved_while_it_runs(manycore, mapfile, platform) -> None:
    write(mapfile, one=f"cluster: 1, {SLEEP}", two=f"cluster: 1, core: 4, {SLEEP}")
    manycore("up", "-d", mapfile)
    text = mapfile.read_text()
    before = nodes_of(manycore, platform)
    refused = {
        ("one", "1:4"): "cluster 1 core 4 is that of 'two': move it first",
        ("one", "1:0"): "found the reserved core 0",
        ("one", "99"): "the clusters of 'host'",
        ("one", "1"): "'one' is on cluster 1 core 1 already",
        ("one", "1:1"): "'one' is on cluster 1 core 1 already",
        ("one", "x"): "expected a cluster such as 2",
    }
    for words, reason in refused.items():
        program = manycore("move", *words, status=2 if "already" not in reason else 1)
        assert reason in program.output
    assert nodes_of(manycore, platform) == before
    moved = manycore("move", "/one", "2:7").output
    assert "one changes: cluster 1 core 1 -> cluster 2 core 7" in moved
    assert "write `cluster: 2`, `core: 7` in line 2" in moved
    manycore("move", "two", "1:1")
    after = nodes_of(manycore, platform)
    assert places(after) == {"one": (2, 7), "two": (1, 1)}
    assert f"`manycore up -d {mapfile}` applies it" in manycore("restart", "one").output
    assert places(nodes_of(manycore, platform)) == places(after)
    assert mapfile.read_text() == text
    back = manycore("up", "-d", mapfile).output
    assert "one changes: cluster 2 core 7 -> cluster 1 core 1" in back
    assert places(nodes_of(manycore, platform)) == {"one": (1, 1), "two": (1, 4)}
    manycore("stop")


def test_a_moved_node_stays_as_its_launch_file_was(manycore, mapfile, platform) -> None:
    launch = mapfile.with_name("two.launch.xml")
    entry = '<executable name="{0}" cmd="sleep {1}"/>'
    entries = [entry.format("one", 1000), entry.format("two", 1000)]
    launch.write_text(f"<launch>{''.join(entries)}</launch>")
    write(mapfile, f"launch_path: {launch.name}\n", one="cluster: 1", two="cluster: 1")
    manycore("up", "-d", mapfile)
    launch.write_text(f"<launch>{entry.format('one', 2000)}</launch>")
    moved = manycore("move", "one", "2").lines
    assert "manycore | one changes: cluster 1 core 1 -> cluster 2 core 1" in moved
    launch.write_text("<launch>")
    manycore("move", "two", "2")
    assert places(nodes_of(manycore, platform)) == {"one": (2, 1), "two": (2, 2)}
    manycore("stop")


def test_a_process_of_another_run_keeps_its_core(manycore, mapfile, platform) -> None:
    talker = "module: rmw_manycore_py.examples.talker"
    write(mapfile, sleeper=f"cluster: 1, {SLEEP}")
    manycore("up", "-d", mapfile)
    more = mapfile.with_name("more.yaml")
    write(more, talker=f"cluster: 2, core: 2, {talker}")
    manycore("up", "-d", "--join", more)
    wait_until(lambda: "/talker" in manycore("node", "list").lines, "it has joined")
    taken = manycore("move", "sleeper", "2:2", status=EXIT_BAD_INPUT)
    assert "expected a core that no node on the platform has" in taken.output
    write(more, talker=f"cluster: 2, core: 3, {talker}", other=f"cluster: 3, {SLEEP}")
    manycore("up", "-d", more)
    expected = {"sleeper": (1, 1), "talker": (2, 3), "other": (3, 1)}
    assert places(nodes_of(manycore, platform)) == expected
    manycore("stop")


def test_two_processes_on_one_core_are_reported(manycore, start, mapfile, platform) -> None:
    command = [sys.executable, "-m", "rmw_manycore_py.examples.talker"]
    first = start(command, MANYCORE_CORE="3")
    first.wait_for("Hello World")
    second = start(command, MANYCORE_CORE="3")
    warning = second.wait_for("cluster 1 core 3 is also that of .*").group()
    assert f"(pid {first.pid}): set another MANYCORE_CORE" in warning
    other = start(command, MANYCORE_CORE="4")
    other.wait_for("Hello World")
    assert "is also that of" not in first.output + other.output
    for program in (first, second, other):
        program.stop()
    talker = "cluster: 1, core: 1, module: rmw_manycore_py.examples.talker"
    write(mapfile, "allow_shared_cores: true\n", one=talker, two=talker)
    manycore("up", "-d", mapfile)
    wait_until(lambda: len(manycore("node", "list").lines) == 2, "both have joined")
    assert "is also that of" not in manycore("logs").output
    manycore("stop")
