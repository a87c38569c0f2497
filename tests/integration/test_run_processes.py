# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""The runner with real processes: plain programs stand in for nodes, so no ROS is needed."""

from __future__ import annotations

import json
import os
import re
import shlex
import signal
import sys
from collections.abc import Callable, Iterator
from pathlib import Path
from typing import Any

import pytest

from rmw_manycore_py.launch.processes.program import NodeProgram
from rmw_manycore_py.launch.processes.state import STOP_STEPS
from rmw_manycore_py.launch.runner import Runner
from rmw_manycore_py.platform.topology import Core
from rmw_manycore_py.process.signals import signal_inbox
from support import TIMEOUT_S, wait_until
from support.processes.commands import peer_command
from support.processes.program import Program

pytestmark = pytest.mark.integration

CPU = min(os.sched_getaffinity(0))
# Handlers write to the descriptor: the signal may come while "ready" is still being printed.
STUBBORN = """
import os, signal, time
for number in (signal.SIGINT, signal.SIGTERM):
    signal.signal(number, lambda *_: os.write(1, b"no\\n"))
print("ready", flush=True)
while True:
    time.sleep(60)
"""
POLITE = """
import os, signal, sys
def leave(*_):
    os.write(1, b"bye\\n")
    sys.exit(0)
signal.signal(signal.SIGINT, leave)
print("ready", flush=True)
while True:
    signal.pause()
"""


def python(source: str) -> list[str]:
    return [sys.executable, "-c", source]


def ignored_signals(pid: int) -> set[int]:
    status = Path(f"/proc/{pid}/status").read_text()
    mask = int(re.search(r"^SigIgn:\s+(\w+)$", status, re.MULTILINE)[1], 16)
    return {number for number in range(1, 65) if mask >> (number - 1) & 1}


def run_programs(
    commands: dict[str, list[str]], host_cpu: int, duration_s: float | None, grace_s: float
) -> None:
    """Run a runner over commands; print its events on standard output."""
    for state, step in STOP_STEPS.items():
        STOP_STEPS[state] = step._replace(grace_s=grace_s)
    programs = [
        NodeProgram(name, tuple(command), dict(os.environ), Core(1, number), (host_cpu,))
        for number, (name, command) in enumerate(commands.items(), start=1)
    ]
    runner = Runner(programs, lambda event: print(event.as_json(), flush=True))
    with signal_inbox() as inbox:
        sys.exit(runner.run(inbox, duration_s))


def run_interrupted() -> None:
    """Run until interrupted while the platform is configured."""
    node = NodeProgram("node", ("sleep", "1000"), dict(os.environ), Core(1, 1), (CPU,))
    runner = Runner([node], lambda event: print(event.as_json(), flush=True))
    with signal_inbox() as inbox:
        os.kill(os.getpid(), signal.SIGINT)
        sys.exit(runner.run(inbox))


class Run:
    """A runner in its own process."""

    def __init__(self, *arguments: Any) -> None:
        self.program = Program(peer_command(run_programs, *arguments), dict(os.environ))

    @property
    def events(self) -> list[dict[str, Any]]:
        return [json.loads(line) for line in self.program.lines if line.startswith("{")]

    def event(self, kind: str, node: str | None = None) -> dict[str, Any]:
        found = [e for e in self.events if e["event"] == kind and node in (None, e.get("node"))]
        assert found, self.program
        return found[-1]

    def wait_for_lines(self, line: str, *nodes: str) -> None:
        """Wait until each of the nodes has printed the line."""
        for node in nodes:
            wanted = {"event": "output", "node": node, "line": line}
            wait_until(lambda: wanted in self.events, f"{node} prints {line}")  # noqa: B023


StartRun = Callable[..., Run]


@pytest.fixture
def start_run() -> Iterator[StartRun]:
    runs: list[Run] = []

    def start(
        host_cpu: int = CPU,
        duration_s: float | None = None,
        grace_s: float = TIMEOUT_S,
        **commands: list[str],
    ) -> Run:
        runs.append(Run(commands, host_cpu, duration_s, grace_s))
        return runs[-1]

    yield start
    for run in runs:
        run.program.kill()


def state_of(pid: int) -> str:
    """Return the state letter of a process in /proc; Z if there is no such process."""
    try:
        stat = Path(f"/proc/{pid}/stat").read_text()
    except (FileNotFoundError, ProcessLookupError):
        return "Z"
    return stat.rsplit(")", 1)[1].split()[0]


def is_gone(pid: int) -> bool:
    """Return whether a process has ended, reaped or not."""
    return state_of(pid) == "Z"


def test_nodes_start_in_order_and_end_by_themselves(start_run: StartRun) -> None:
    run = start_run(first=python("print('one')"), second=python("print('two', end='')"))
    assert run.program.wait() == 0
    assert [e["node"] for e in run.events if e["event"] == "started"] == ["first", "second"]
    assert run.event("output", "first")["line"] == "one"
    assert run.event("output", "second")["line"] == "two"
    assert run.event("ended", "first")["state"] == "finished"
    assert not any(e["event"] == "stopping" for e in run.events)


def test_a_node_runs_on_its_cpu_from_its_first_instruction(start_run: StartRun) -> None:
    source = "import os; print(os.sched_getaffinity(0))"
    cpu = max(os.sched_getaffinity(0))
    run = start_run(host_cpu=cpu, node=python(source))
    assert run.program.wait() == 0
    assert run.event("started")["host_cpu"] == cpu
    assert run.event("output")["line"] == str({cpu})


def test_a_failed_node_is_reported_with_its_last_words(start_run: StartRun) -> None:
    run = start_run(bad=python("import sys; print('why'); sys.exit(3)"), good=python("pass"))
    assert run.program.wait() == 1
    ended = run.event("ended", "bad")
    assert (ended["state"], ended["exit_status"], ended["reason"]) == ("failed", 3, "exit status 3")
    assert ended["last_lines"] == ["why"]
    assert run.event("ended", "good")["state"] == "finished"


def test_a_crash_is_reported_by_the_name_of_its_signal(start_run: StartRun) -> None:
    run = start_run(node=python("import os, signal; os.kill(os.getpid(), signal.SIGSEGV)"))
    assert run.program.wait() == 1
    ended = run.event("ended")
    assert (ended["signal"], ended["exit_status"]) == ("SIGSEGV", None)
    assert "SIGSEGV" in ended["reason"]


def test_the_others_go_on_when_one_node_is_killed(start_run: StartRun) -> None:
    run = start_run(victim=python(POLITE), other=python(POLITE))
    run.wait_for_lines("ready", "victim", "other")
    os.kill(run.event("started", "victim")["pid"], signal.SIGKILL)
    run.program.wait_for('"event": "ended", "node": "victim"')
    assert run.program.is_running()
    run.program.signal(signal.SIGINT)
    assert run.program.wait() == 1
    assert run.event("ended", "other")["state"] == "finished"


@pytest.mark.parametrize("number", [signal.SIGINT, signal.SIGTERM, signal.SIGHUP])
def test_a_signal_stops_the_nodes_cleanly(start_run: StartRun, number: signal.Signals) -> None:
    run = start_run(one=python(POLITE), two=python(POLITE))
    run.wait_for_lines("ready", "one", "two")
    run.program.signal(number)
    assert run.program.wait() == 0
    assert run.event("stopping")["reason"] == number.name
    for name in ("one", "two"):
        assert run.event("output", name)["line"] == "bye"
        assert run.event("ended", name)["reason"] == "stopped"


@pytest.mark.parametrize("duration_s", [720 * 3600.0, float("inf")])
def test_a_duration_may_be_long(start_run: StartRun, duration_s: float) -> None:
    run = start_run(duration_s=duration_s, node=python(POLITE))
    run.wait_for_lines("ready", "node")
    run.program.signal(signal.SIGINT)
    assert run.program.wait() == 0


def test_who_ignores_hanging_up_may_log_out(start_run: StartRun) -> None:
    before = signal.signal(signal.SIGHUP, signal.SIG_IGN)  # like nohup; children inherit it
    try:
        run = start_run(node=python(POLITE))
    finally:
        signal.signal(signal.SIGHUP, before)
    run.wait_for_lines("ready", "node")
    assert signal.SIGHUP in ignored_signals(run.program.pid)
    assert signal.SIGINT not in ignored_signals(run.program.pid)
    run.program.signal(signal.SIGHUP)
    run.program.signal(signal.SIGINT)
    assert run.program.wait() == 0
    assert run.event("stopping")["reason"] == "SIGINT"


def test_a_node_without_handler_that_dies_of_the_interrupt_did_not_fail(
    start_run: StartRun,
) -> None:
    run = start_run(node=["sleep", "1000"])
    run.program.wait_for('"started"')
    run.program.signal(signal.SIGINT)
    assert run.program.wait() == 0
    assert (run.event("ended")["state"], run.event("ended")["signal"]) == ("finished", "SIGINT")


def test_a_signal_that_comes_before_the_first_node_starts_none() -> None:
    program = Program(peer_command(run_interrupted), dict(os.environ))
    assert program.wait() == 0, program
    assert [json.loads(line) for line in program.lines] == [
        {"event": "stopping", "reason": "SIGINT"}
    ]
    program.kill()


def test_the_duration_ends_the_run(start_run: StartRun) -> None:
    run = start_run(duration_s=0.2, node=["sleep", "1000"])
    assert run.program.wait() == 0
    assert run.event("stopping")["reason"] == "the duration is over"


def test_a_stubborn_node_is_killed_when_its_time_is_up(start_run: StartRun) -> None:
    run = start_run(node=python(STUBBORN), grace_s=0.1)
    run.wait_for_lines("ready", "node")
    run.program.signal(signal.SIGINT)
    assert run.program.wait() == 1
    assert [e["signal"] for e in run.events if e["event"] == "signal_escalated"] == [
        "SIGTERM",
        "SIGKILL",
    ]
    assert "did not stop" in run.event("ended")["reason"]


def test_who_interrupts_again_does_not_wait(start_run: StartRun) -> None:
    run = start_run(node=python(STUBBORN), grace_s=1e6)
    run.wait_for_lines("ready", "node")
    for number in ("SIGTERM", "SIGKILL"):
        run.program.signal(signal.SIGINT)
        run.program.wait_for('"line": "no"')
        assert not any(e.get("signal") == number for e in run.events)
    run.program.signal(signal.SIGINT)
    assert run.program.wait() == 1


def test_stopped_processes_are_stopped_too(start_run: StartRun) -> None:
    run = start_run(node=["sleep", "1000"])
    run.program.wait_for('"started"')
    pid = run.event("started")["pid"]
    os.kill(pid, signal.SIGSTOP)
    wait_until(lambda: state_of(pid) == "T", "the node is stopped")
    for _ in range(3):
        run.program.signal(signal.SIGINT)
        run.program.wait_for('"stopping"|"signal_escalated"')
    assert run.program.wait() == 1
    assert is_gone(pid)


def test_children_of_a_node_die_with_it(start_run: StartRun) -> None:
    run = start_run(node=["sh", "-c", "sleep 1000 & echo $!; kill -KILL $$"])
    assert run.program.wait() == 1
    child = int(run.event("output")["line"])
    wait_until(lambda: is_gone(child), "the child of the node is gone")


def test_a_node_that_cannot_start_stops_those_before_it(start_run: StartRun) -> None:
    run = start_run(one=python(POLITE), two=["no-such-program"], three=python(POLITE))
    assert run.program.wait() == 1
    assert "no-such-program" in run.event("ended", "two")["reason"]
    assert "two could not be started" in run.event("stopping")["reason"]
    assert is_gone(run.event("started", "one")["pid"])
    assert not any(e.get("node") == "three" for e in run.events)


def test_a_cpu_that_does_not_exist_is_named(start_run: StartRun) -> None:
    run = start_run(host_cpu=1000, node=["true"])
    assert run.program.wait() == 1
    assert "host CPU 1000" in run.event("ended")["reason"]


def test_nodes_die_with_a_killed_runner(start_run: StartRun) -> None:
    run = start_run(node=python(STUBBORN))
    run.wait_for_lines("ready", "node")
    pid = run.event("started")["pid"]
    run.program.kill()
    wait_until(lambda: is_gone(pid), "the node dies with the runner")


def test_a_reader_that_closes_the_pipe_ends_the_run() -> None:
    endless = {"node": ["sh", "-c", "while echo again; do sleep 0.01; done"]}
    command = shlex.join(peer_command(run_programs, endless, CPU, None, TIMEOUT_S))
    pipeline = Program(["sh", "-c", f"{command} | head -n 3"], dict(os.environ))
    pipeline.wait()
    pipeline.kill()
    assert is_gone(json.loads(pipeline.lines[0])["pid"])


def test_long_lines_and_foreign_bytes_pass(start_run: StartRun) -> None:
    source = "import sys; sys.stdout.buffer.write(b'x' * 200_000 + b'\\xff\\n')"
    run = start_run(node=python(source))
    assert run.program.wait() == 0
    text = "".join(e["line"] for e in run.events if e["event"] == "output")
    assert text == "x" * 200_000 + "\ufffd"
