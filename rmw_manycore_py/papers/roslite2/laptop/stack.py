# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""Off-loaded nodes started by the laptop program, on the platform or on plain DDS."""

from __future__ import annotations

import json
import os
import signal
import subprocess
import threading
from collections.abc import Callable
from pathlib import Path
from typing import Any, Protocol

from rmw_manycore_program import own_program
from rmw_manycore_py.errors import EXIT_BAD_INPUT, ManycoreError
from rmw_manycore_py.launch.processes.environment import outside_environment
from rmw_manycore_py.mapfile import load_mapfile, resolve
from rmw_manycore_py.papers.roslite2.laptop.network_namespace import entering, packets_received
from rmw_manycore_py.process.cpu_time import process_cpu_s, tree_cpu_s
from rmw_manycore_py.process.parent_death import dies_with_this_process

BRIDGE = "(bridge"
STOPPING_S = 20.0

Tell = Callable[[str], None]


class Stack(Protocol):
    """Processes of the off-loaded nodes."""

    @property
    def pids(self) -> dict[str, int]:
        """Latest process of each node, and of the bridge."""

    def check(self) -> None:
        """Raise ManycoreError if they have ended."""

    def note_cpu(self) -> None:
        """Save the CPU times of processes that may die; call it periodically."""

    def cpu_s(self) -> tuple[float, float | None]:
        """Return the CPU time of all processes, and of the bridge if there is one."""

    def packets_received(self) -> int | None:
        """Return the packets received by the network namespace; None in the laptop's own."""

    def close(self) -> None:
        """Stop all processes."""


class PlatformStack:
    """`manycore run MAPFILE`; warnings and restarts of its nodes are reported."""

    def __init__(self, mapfile: Path, tell: Tell, namespace: str | None = None) -> None:
        self._tell, self._namespace = tell, namespace
        self._bridge_cpu_s: dict[int, float] = {}  # last value by process
        self.pids: dict[str, int] = {}
        self._last_lines: list[str] = []
        self._process = subprocess.Popen(
            [
                *entering(namespace),
                *own_program("rmw_manycore_py.cli", "run", str(mapfile), "--json"),
            ],
            stdout=subprocess.PIPE,
            stderr=subprocess.STDOUT,
            text=True,
            start_new_session=True,  # the laptop handles Ctrl-C and stops the run
            preexec_fn=dies_with_this_process(),
        )
        self._reader = threading.Thread(target=self._read, daemon=True)
        self._reader.start()

    def _read(self) -> None:
        assert self._process.stdout is not None
        for line in self._process.stdout:
            try:
                event = json.loads(line)
            except ValueError:
                self._last_lines.append(line.rstrip())
                continue
            self._note(event)

    def _note(self, event: dict[str, Any]) -> None:
        kind, node = event.get("event"), event.get("node", "")
        if kind == "started":
            self.pids[node] = event["pid"]
        elif kind == "restarting":
            self._tell(f"{node} {event['reason']}: it is started again")
        elif kind == "output":
            _tell_warning(self._tell, node, event["line"])
        if kind in ("output", "ended", "stopping"):
            text = event.get("line") or event.get("reason") or ""
            self._last_lines = [*self._last_lines[-9:], f"{node}: {text}"]

    def check(self) -> None:
        """Raise ManycoreError with the last output if the run has ended."""
        if self._process.poll() is not None:
            self._reader.join(timeout=1.0)
            said = "\n  ".join(self._last_lines)
            raise ManycoreError(f"the run of the platform has ended:\n  {said}")

    def note_cpu(self) -> None:
        """Save CPU times; see Stack."""
        for node, pid in dict(self.pids).items():
            if node.startswith(BRIDGE):
                self._bridge_cpu_s[pid] = max(process_cpu_s(pid), self._bridge_cpu_s.get(pid, 0.0))

    def cpu_s(self) -> tuple[float, float | None]:
        """Return CPU times; see Stack."""
        self.note_cpu()
        return tree_cpu_s(self._process.pid), sum(self._bridge_cpu_s.values())

    def packets_received(self) -> int | None:
        """Return received packets; see Stack."""
        return None if self._namespace is None else packets_received(self._process.pid)

    def close(self) -> None:
        """Stop the run, like Ctrl-C."""
        if self._process.poll() is None:
            self._process.send_signal(signal.SIGINT)
        try:
            self._process.wait(STOPPING_S)
        except subprocess.TimeoutExpired:
            self._process.send_signal(signal.SIGINT)
            self._process.wait()


class PlainStack:
    """Nodes of a mapfile as ordinary processes on Fast DDS, each on the same host CPU."""

    def __init__(self, mapfile: Path, tell: Tell, namespace: str | None = None) -> None:
        self._namespace = namespace
        placement = resolve(load_mapfile(mapfile))
        self._processes = {
            node.name: subprocess.Popen(
                [*entering(namespace), *node.argv],
                cwd=node.cwd,
                env=outside_environment({**os.environ, **node.env}),
                stdout=subprocess.PIPE,
                stderr=subprocess.STDOUT,
                text=True,
                preexec_fn=_pinned(node.host_cpu),
            )
            for node in placement.nodes
        }
        for name, process in self._processes.items():
            threading.Thread(target=_read, args=(name, process, tell), daemon=True).start()

    @property
    def pids(self) -> dict[str, int]:
        """Return the processes; see Stack."""
        return {name: process.pid for name, process in self._processes.items()}

    def check(self) -> None:
        """Raise ManycoreError if a node has ended."""
        for name, process in self._processes.items():
            if process.poll() is not None:
                raise ManycoreError(f"{name} has ended with exit status {process.returncode}")

    def note_cpu(self) -> None:
        """Do nothing: there is no bridge."""

    def cpu_s(self) -> tuple[float, float | None]:
        """Return CPU times; see Stack."""
        return sum(tree_cpu_s(process.pid) for process in self._processes.values()), None

    def packets_received(self) -> int | None:
        """Return received packets; see Stack."""
        pid = next(iter(self._processes.values())).pid
        return None if self._namespace is None else packets_received(pid)

    def close(self) -> None:
        """Stop the nodes."""
        for process in self._processes.values():
            process.send_signal(signal.SIGINT)
        for process in self._processes.values():
            try:
                process.wait(STOPPING_S)
            except subprocess.TimeoutExpired:
                process.kill()
                process.wait()


def _read(node: str, process: subprocess.Popen[str], tell: Tell) -> None:
    assert process.stdout is not None
    for line in process.stdout:
        _tell_warning(tell, node, line.rstrip())


def _tell_warning(tell: Tell, node: str, line: str) -> None:
    if "[WARN]" in line or "[ERROR]" in line:
        tell(f"{node}: {line.rpartition(']: ')[2]}")


def _pinned(cpu: int) -> Callable[[], None]:
    dies = dies_with_this_process()

    def before_exec() -> None:
        dies()
        os.sched_setaffinity(0, {cpu})

    return before_exec


def pid_of(stack: Stack | None, target: str) -> int:
    """Return the process of a fault's target; `bridge inward` means `(bridge inward)`."""
    if stack is None:
        raise ManycoreError(
            f"--fault: {target} is a process of the stack: start it with --run",
            EXIT_BAD_INPUT,
        )
    pids = stack.pids
    for name in (target, f"({target})"):
        if name in pids:
            return pids[name]
    raise ManycoreError(
        f"--fault: expected one of {', '.join(sorted(pids))}, found '{target}'", EXIT_BAD_INPUT
    )
