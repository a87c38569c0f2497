# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""Runs that a Python program has started: their nodes, their ends, and what is refused."""

from __future__ import annotations

import os
import signal
import threading
from pathlib import Path
from queue import Queue

import pytest

import rmw_manycore_py as manycore
from support import TIMEOUT_S, wait_until
from support.nodes import timed
from support.nodes.ros import announce
from support.processes.commands import peer_command
from support.processes.inspection import kill
from support.processes.platforms import environment
from support.processes.program import Program

pytestmark = pytest.mark.integration

NODE = "  {name}: {{command: [sh, -c, '{script}'], ros_arguments: false, cluster: {cluster}}}\n"
STAYS = "echo up; exec sleep 1000"


@pytest.fixture(autouse=True)
def place(platform: str, monkeypatch: pytest.MonkeyPatch) -> None:
    """Have this process start runs on the test's platform."""
    variables = environment(platform)
    for name in ("MANYCORE_PLATFORM", "ROS_DOMAIN_ID"):
        monkeypatch.setenv(name, variables[name])


@pytest.fixture
def mapfile(tmp_path: Path):
    """Return a function that writes a mapfile of shell scripts."""

    def write(**scripts: str) -> Path:
        file = tmp_path / "map.yaml"
        nodes = (
            NODE.format(name=name, script=script, cluster=cluster)
            for cluster, (name, script) in enumerate(scripts.items(), start=1)
        )
        file.write_text("nodes:\n" + "".join(nodes))
        return file

    return write


def test_nodes_run_until_the_end_of_with(mapfile, platform: str) -> None:
    lines: list[tuple[str, str]] = []
    said = threading.Event()

    def hear(node: str, line: str) -> None:
        lines.append((node, line))
        if len(lines) == 2:
            said.set()

    with manycore.run(mapfile(one=STAYS, two=STAYS), on_output=hear) as active:
        assert active.platform == platform
        one, two = active.nodes
        assert (one.name, one.cluster, one.core, one.state) == ("one", 1, 1, "running")
        assert (two.name, two.cluster) == ("two", 2)
        assert Path(f"/proc/{two.pid}").exists()
        assert said.wait(TIMEOUT_S)
        assert sorted(lines) == [("one", "up"), ("two", "up")]
        assert active.wait(0.01) is None
    assert [node.state for node in active.nodes] == ["finished", "finished"]
    assert not Path(f"/proc/{two.pid}").exists()
    assert (active.wait(), active.stop()) == (0, 0)
    assert platform not in manycore.platforms()


def test_a_mapfile_asks_for_virtual_time(timed_mapfile) -> None:
    file = timed_mapfile(timed, "talker", "echo")
    file.write_text(f"clock: virtual\n{file.read_text()}")
    heard: Queue[str] = Queue()
    with manycore.run(file, on_output=lambda _, line: heard.put(line)):
        *_, at_ns = heard.get(timeout=TIMEOUT_S).split()
    assert 0 <= int(at_ns) - 10**18 < 10**12


def test_a_node_that_fails(mapfile) -> None:
    active = manycore.run(mapfile(good="true", bad="exit 3"))
    assert active.wait(TIMEOUT_S) == 1
    good, bad = active.nodes
    assert (good.state, bad.state) == ("finished", "failed")
    assert "3" in bad.reason


def test_an_error_in_a_callback_comes_where_it_is_waited_for(mapfile) -> None:
    def fail(_: str, line: str) -> None:
        raise RuntimeError(line)

    active = manycore.run(mapfile(one="echo first; echo second"), on_output=fail)
    with pytest.raises(RuntimeError, match="first"):
        active.wait(TIMEOUT_S)
    assert active.wait() == 0


def test_a_mapfile_with_mistakes_is_refused(tmp_path: Path) -> None:
    file = tmp_path / "map.yaml"
    file.write_text("nodes:\n  one: {module: no.such.module, cluster: 1}\n  two: {clusters: 2}\n")
    with pytest.raises(manycore.MapfileError) as found:
        manycore.run(file)
    assert [problem.line for problem in found.value.problems] == [3, 3]
    with pytest.raises(manycore.MapfileError, match=r"missing\.yaml"):
        manycore.run(tmp_path / "missing.yaml")


def test_a_platform_that_runs_already_is_refused(mapfile, platform: str) -> None:
    file = manycore.load_mapfile(mapfile(one=STAYS))
    with manycore.run(file) as active:
        with pytest.raises(manycore.ManycoreError, match=f"'{platform}' is running already"):
            manycore.run(file)
        assert active.wait(0) is None


def test_a_killed_supervisor_is_an_error(mapfile) -> None:
    file = mapfile(one=STAYS)
    active = manycore.run(file)
    os.kill(active.pid, signal.SIGKILL)
    with pytest.raises(manycore.ManycoreError, match="was killed"):
        active.wait(TIMEOUT_S)
    pid = active.nodes[0].pid
    wait_until(lambda: not Path(f"/proc/{pid}").exists(), "the node ends with its supervisor")
    with manycore.run(file) as again:  # which wipes what is left of the platform
        assert again.wait(0) is None


def run_until_interrupted(mapfile: str) -> None:
    try:
        with manycore.run(mapfile) as active:
            announce(f"runs {active.nodes[0].pid} under {active.pid}")
            active.wait()
    except KeyboardInterrupt:
        announce("interrupted")


@pytest.mark.parametrize("end", ["stop", "kill"])
def test_nodes_end_with_the_program_that_started_them(
    start, mapfile, platform: str, end: str
) -> None:
    program: Program = start(peer_command(run_until_interrupted, str(mapfile(one=STAYS))))
    pid, supervisor = program.wait_for(r"^runs (\d+) under (\d+)$").groups()
    try:
        if end == "stop":
            assert program.stop() == 0, program
            assert "interrupted" in program.lines
        else:
            program.signal(signal.SIGKILL)
        wait_until(lambda: not Path(f"/proc/{pid}").exists(), "the node has ended")
        wait_until(lambda: platform not in manycore.platforms(), "the platform is gone")
    finally:
        kill(int(supervisor))  # it has the program's output, which is read to its end
