# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""The nodes of a skeleton exchange messages at its rates, and their losses are counted."""

from __future__ import annotations

import json
import os
import signal
import subprocess
import sys
from collections.abc import Callable, Iterator
from contextlib import suppress
from pathlib import Path

import pytest

from rmw_manycore_py.bench.contenders import FAST_DDS, INSIDE, Middleware
from rmw_manycore_py.bench.idle import wait_until_quiet
from rmw_manycore_py.bench.scale.skeleton import skeleton_of
from rmw_manycore_py.bench.scale.skeleton_run import SkeletonRun
from rmw_manycore_py.bench.session import Session, usable_cpus
from rmw_manycore_py.errors import ManycoreError
from rmw_manycore_py.profile.files import save
from support import TIMEOUT_S, wait_until
from support.processes.commands import manycore_command
from support.samples.profiles import queued

pytestmark = pytest.mark.integration

FILTER = 1
PUBLISHED_S = 1.0
SLEEP, LOOP = "import time; time.sleep(60)", "while True: pass"
DEEP = 100  # more than is published, however late a node takes

Start = Callable[[int], SkeletonRun]


@pytest.fixture(params=[INSIDE, FAST_DDS], ids=["manycore", "fast_dds"])
def start(request: pytest.FixtureRequest) -> Iterator[Start]:
    """Start the nodes of the pipeline, with queues of a depth."""
    middleware: Middleware = request.param

    def started(depth: int) -> SkeletonRun:
        return SkeletonRun(session, skeleton_of(queued(depth)))

    with Session(middleware, usable_cpus()) as session:
        yield started


def test_each_message_reaches_its_subscription(start: Start) -> None:
    nodes = start(DEEP)
    nodes.publish(PUBLISHED_S)
    nodes.settle()
    found = nodes.finish()
    assert found.published > 0
    assert found.due == found.published
    assert found.lost == 0
    assert min(found.ages_ns) > 0


def test_messages_that_a_stopped_node_does_not_take_are_lost(start: Start) -> None:
    nodes = start(1)
    os.kill(nodes.pids[FILTER], signal.SIGSTOP)
    nodes.publish(PUBLISHED_S)
    os.kill(nodes.pids[FILTER], signal.SIGCONT)
    nodes.settle(timeout_s=2)
    assert nodes.finish().lost > 0


def test_a_killed_node_is_named(start: Start) -> None:
    nodes = start(DEEP)
    os.kill(nodes.pids[FILTER], signal.SIGKILL)
    with pytest.raises(ManycoreError, match=r"name=/filter(.|\n)*exit status -9"):
        nodes.settle()


@pytest.mark.long
def test_a_node_that_dies_costs_no_smaller_application_its_figures(tmp_path: Path) -> None:
    save(queued(100), tmp_path / "profile.json")
    words = ("autoware", tmp_path / "profile.json", "--only", "manycore", "--quick", "--json")
    command = [str(word) for word in manycore_command("bench", *words)]
    with subprocess.Popen(
        command, text=True, stdout=subprocess.PIPE, stderr=subprocess.PIPE
    ) as bench:
        try:
            wait_until(lambda: has_tool_beside(3, bench.pid), "a tool sees 3 nodes")
            os.kill(nodes_of(bench.pid)[-1], signal.SIGKILL)
            output, errors = bench.communicate(timeout=10 * TIMEOUT_S)
        finally:
            bench.kill()
    assert bench.returncode == 1
    report = json.loads(output)
    assert {row["at"] for row in report["results"]} == {1}
    (failure,) = report["failures"]
    assert "3 nodes" in failure
    assert "name=/sink" in failure
    assert "Traceback" not in errors


def test_a_process_is_not_quiet_while_others_keep_it_from_running() -> None:
    sleeping, busy = (subprocess.Popen([sys.executable, "-c", code]) for code in (SLEEP, LOOP))
    try:
        assert wait_until_quiet([sleeping.pid])
        assert not wait_until_quiet([busy.pid], timeout_s=1.5)
    finally:
        for one in (sleeping, busy):
            one.kill()
            one.wait()


def commands_of(pid: int) -> dict[int, str]:
    """Return the command lines of the children of a process."""
    found: dict[int, str] = {}
    for child in Path(f"/proc/{pid}/task/{pid}/children").read_text().split():
        with suppress(FileNotFoundError, ProcessLookupError):  # it has ended in the meantime
            found[int(child)] = Path(f"/proc/{child}/cmdline").read_text()
    return found


def nodes_of(bench: int) -> list[int]:
    return [pid for pid, command in commands_of(bench).items() if "skeleton_node" in command]


def has_tool_beside(nodes: int, bench: int) -> bool:
    commands = commands_of(bench).values()
    return len(nodes_of(bench)) == nodes and any("rmw_manycore_py.cli" in one for one in commands)
