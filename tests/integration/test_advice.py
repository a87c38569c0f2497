# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""Messages that name a command: the command is run as quoted, and the state is cured.

Tests of the part that prints such a message do so, too (`run_quoted`). For `manycore clean`, which
cures damage of every kind, tests/integration/test_clean.py does.
"""

from __future__ import annotations

import json
import os
import re
import shlex
import signal
from collections.abc import Callable
from pathlib import Path

import pytest

from rmw_manycore_py.launch.runs.directory import runs_of
from rmw_manycore_py.mapfile.installed import installed_mapfiles
from support import IS_MANYCORE, wait_until
from support.peers.programs import forked_example, forked_manycore
from support.processes.commands import manycore_command
from support.processes.inspection import kill_all
from support.processes.own_shm import can_mount
from support.processes.program import Program
from support.sources.advice import quoted, run_quoted

pytestmark = [
    pytest.mark.integration,
    pytest.mark.skipif(not IS_MANYCORE, reason="manycore is about rmw_manycore"),
]

MAPFILE = """
nodes:
  plain: {cluster: 1, command: [sleep, '1000'], ros_arguments: false}
  typed: {cluster: 1, command: [cat], ros_arguments: false, terminal: true}
"""
Run = Callable[..., Program]


@pytest.fixture
def manycore(start) -> Run:
    """Run `manycore` and check its exit status."""

    def call(*words: str | Path, status: int = 0) -> Program:
        program: Program = start(forked_manycore(*map(str, words)))
        assert program.wait() == status, program
        return program

    return call


@pytest.fixture
def follow(manycore) -> Callable[[Program, str], Program]:
    """Run the command that a program's last message quotes and that begins with some words."""

    def run(program: Program, words: str) -> Program:
        found = [one for one in quoted(program.output) if one.startswith(words)]
        assert found, f"no `{words} ...` is advised by {program}"
        return manycore(*shlex.split(found[-1])[1:])

    return run


@pytest.fixture
def up(start, tmp_path: Path, platform: str):
    """Start a run in the background; it ends with the test."""
    mapfile = tmp_path / "map.yaml"
    mapfile.write_text(MAPFILE)

    def call(status: int = 0) -> Program:
        program = start(manycore_command("up", "-d", mapfile))
        assert program.wait() == status, program
        return program

    yield call
    for run in runs_of(platform):
        if run.is_alive:
            start(forked_manycore("stop", "--now")).wait()


def state_of(manycore: Run, node: str) -> str:
    runs = json.loads(manycore("ps", "--json").output)
    return next(str(row["state"]) for run in runs for row in run["nodes"] if row["name"] == node)


def test_a_platform_that_is_running_already_is_stopped(up, follow, manycore, tmp_path) -> None:
    up()
    other = tmp_path / "other.yaml"
    other.write_text(MAPFILE)
    follow(manycore("up", "-d", other, status=1), "manycore stop")
    up()


def test_a_run_in_the_background_is_stopped(up, manycore) -> None:
    said = up().lines[-1].partition("in the background: ")[2]
    for command in said.split("; "):
        if "logs" not in command:  # it would follow for ever
            manycore(*shlex.split(command)[1:])
    up()


def test_a_stopped_supervisor_is_continued(up, manycore, platform) -> None:
    up()
    (run,) = runs_of(platform)
    os.kill(int(run.info["pid"]), signal.SIGSTOP)
    silent = manycore("stop", status=1)
    run_quoted(silent.output, "kill -CONT")
    manycore("stop")


def test_a_node_is_restarted_and_its_log_shown(up, manycore, follow) -> None:
    up()
    manycore("stop", "typed")
    refused = manycore("attach", "typed", status=1)
    follow(refused, "manycore logs")
    follow(refused, "manycore restart")
    assert state_of(manycore, "typed") == "running"


def test_a_node_is_given_a_terminal(up, start, manycore) -> None:
    up()
    (command,) = quoted(manycore("attach", "plain", status=1).lines[-1])
    attached = start(manycore_command(*shlex.split(command)[1:]))
    wait_until(lambda: has_terminal(manycore, "plain"), "it has a terminal")
    attached.signal(signal.SIGTERM)
    attached.wait()
    assert state_of(manycore, "plain") == "running"


def has_terminal(manycore: Run, node: str) -> bool:
    runs = json.loads(manycore("ps", "--json").output)
    rows = [row for run in runs for row in run["nodes"] if row["name"] == node]
    return any(row["terminal"] and row["state"] == "running" for row in rows)


def test_a_trace_is_stopped_saved_or_discarded(start, manycore, follow, tmp_path) -> None:
    talker = start(forked_example("talker"))

    def record() -> None:
        talker.skip_output()
        talker.wait_for("Publishing")

    record()
    follow(manycore("trace", "stop", status=1), "manycore trace start")
    record()
    follow(manycore("trace", "start", status=1), "manycore trace stop")
    unsaved = manycore("trace", "start", status=1)
    follow(unsaved, "manycore trace start --discard")
    record()
    manycore("trace", "stop")
    (save,) = (one for one in quoted(unsaved.output) if " save " in one)
    file = tmp_path / "trace.json"
    manycore(*shlex.split(save.replace("FILE", str(file)))[1:])
    assert file.exists()
    manycore("trace", "start")
    manycore("trace", "stop")


def test_names_that_exist_are_listed(start, manycore, follow) -> None:
    start(forked_example("talker")).wait_for("Publishing")
    unknown = manycore("node", "info", "--spin-time", "0", "/nothing_like_it", status=1)
    assert "/talker" in follow(unknown, "manycore node list").lines
    traced = manycore("trace", "start", "--node", "/nothing_like_it", status=1)
    assert "/talker" in follow(traced, "manycore node list").lines


@pytest.mark.parametrize(
    ("command", "advised"),
    [
        (("component", "unload", "/no_container", "1"), "manycore component list"),
        (("lifecycle", "get", "/no_node"), "manycore lifecycle nodes"),
    ],
)
def test_containers_and_lifecycle_nodes_are_listed(start, manycore, follow, command, advised):
    start(forked_example("talker")).wait_for("Publishing")
    follow(manycore(*command, status=1), advised)


@pytest.mark.skipif(not can_mount(), reason="needs a mount namespace, to hide files")
def test_the_doctor_names_the_missing_mapfile(start, tmp_path) -> None:
    mapfiles = installed_mapfiles()["whill"].parent
    script = f'mount -t tmpfs tmpfs {mapfiles} && "$0" whill course "$1"; "$0" doctor'
    manycore = manycore_command()[0]
    command = ["unshare", "--mount", "sh", "-c", script, manycore, tmp_path / "course"]
    program = start([str(word) for word in command])
    program.wait()
    assert "whill.yaml is not installed" in program.output
    assert "manycore doctor" in quoted(program.output)
    assert re.search(r"^failure +mapfiles: no .*whill\.yaml", program.output, re.M), program


def test_a_dead_platform_is_removed(start, manycore, platform) -> None:
    """Without names, `manycore clean` would also remove what other tests are looking at."""
    start(forked_example("talker")).wait_for("Publishing")
    kill_all(platform)
    status = manycore("status", "--platform", platform)
    (command,) = quoted(status.output)
    assert command == "manycore clean"
    manycore("clean", platform)
    assert "no platform" in manycore("status", "--platform", platform, status=1).output
