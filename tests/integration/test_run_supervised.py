# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""Supervised processes of a run: which ones are restarted, and which ones end the run."""

from __future__ import annotations

import json
import os
import signal
import sys
from pathlib import Path

import pytest

from rmw_manycore_py.launch import runner
from rmw_manycore_py.launch.processes.program import NodeProgram
from rmw_manycore_py.platform.topology import Core
from rmw_manycore_py.process.signals import signal_inbox
from support.processes.commands import peer_command
from support.processes.program import Program

pytestmark = pytest.mark.integration

DIES_AT_ONCE = "import sys; print('why'); sys.exit(int(sys.argv[1]))"
# Becomes ready in each third process; the sixth one stays.
COMES_UP_AT_TIMES = """
import os, signal, sys
from rmw_manycore_py.process.readiness import report_ready
with open(sys.argv[1], "a") as file:
    file.write("x")
starts = os.path.getsize(sys.argv[1])
if starts % 3 == 0:
    report_ready()
if starts < 6:
    sys.exit(1)
print("stays", flush=True)
signal.pause()
"""


def run_server(source: str, *arguments: str) -> None:
    """Run a runner over a supervised server and a node."""
    runner.RESTART_PAUSE_S = 0.01
    server = (sys.executable, "-c", source, *arguments)
    cpus = (min(os.sched_getaffinity(0)),)
    programs = [
        NodeProgram("server", server, dict(os.environ), Core(1, 1), cpus, supervised=True),
        NodeProgram("node", ("sleep", "1000"), dict(os.environ), Core(1, 2), cpus),
    ]
    started = runner.Runner(programs, lambda event: print(event.as_json(), flush=True))
    with signal_inbox() as inbox:
        sys.exit(started.run(inbox))


@pytest.fixture
def start_server():
    programs: list[Program] = []

    def start(*arguments: str) -> Program:
        programs.append(Program(peer_command(run_server, *arguments), dict(os.environ)))
        return programs[-1]

    yield start
    for program in programs:
        program.kill()


def events(program: Program, kind: str, node: str) -> list[dict]:
    found = [json.loads(line) for line in program.lines if line.startswith("{")]
    return [e for e in found if e["event"] == kind and node in (None, e.get("node"))]


@pytest.mark.parametrize("status", [0, 7])
def test_what_never_comes_up_ends_the_run(start_server, status: int) -> None:
    run = start_server(DIES_AT_ONCE, str(status))
    assert run.wait() == 1
    assert len(events(run, "started", "server")) == runner.MAX_FAILED_STARTS
    (ended,) = events(run, "ended", "server")
    assert (ended["state"], ended["reason"]) == ("failed", f"exit status {status}")
    assert ended["last_lines"] == ["why"]
    assert "server ended 3 times before it had come up" in run.output
    assert [e["state"] for e in events(run, "ended", "node")] == ["finished"]


def test_what_comes_up_now_and_then_is_started_again(start_server, tmp_path: Path) -> None:
    run = start_server(COMES_UP_AT_TIMES, str(tmp_path / "starts"))
    run.wait_for('"line": "stays"')
    assert len(events(run, "restarting", "server")) == 5
    run.signal(signal.SIGINT)
    assert run.wait() == 0
