# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""A run started by a Python program, with a separate supervisor process like `manycore run`."""

from __future__ import annotations

import json
import signal
import subprocess
import threading
from collections.abc import Callable
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Any, Literal

from typing_extensions import Self

from rmw_manycore_program import own_program
from rmw_manycore_py.errors import ManycoreError
from rmw_manycore_py.launch.events import Ended, Event, Platform, Started, event_of
from rmw_manycore_py.mapfile import Mapfile, load_mapfile, resolve
from rmw_manycore_py.platform.topology import HostCpu

OnOutput = Callable[[str, str], None]


@dataclass(frozen=True)
class NodeStatus:
    """A process of a run: a node, or a process of the bridge, whose name is in parentheses.

    :param name: name in the mapfile.
    :param pid: process id, the latest one after a restart.
    :param cluster: counted from 1.
    :param core: counted from 0 in its cluster.
    :param host_cpu: CPU or CPUs that it is pinned to; None if it is not pinned.
    :param state: ``running``, ``finished`` after a successful end, or ``failed``.
    :param reason: how it ended; empty while it runs.
    """

    name: str
    pid: int
    cluster: int
    core: int
    host_cpu: HostCpu
    state: Literal["running", "finished", "failed"] = "running"
    reason: str = ""


class ActiveRun:
    """The nodes of a mapfile, started together; created by `run`.

    They stop at the end of the `with` block, and whenever this process ends, killed or not.
    """

    def __init__(self, mapfile: Path, on_output: OnOutput | None) -> None:
        self._on_output = on_output
        self._nodes: dict[str, NodeStatus] = {}
        self._platform = ""
        self._told = threading.Event()
        self._is_up = False
        self._error: BaseException | None = None
        self._process = subprocess.Popen(
            own_program("rmw_manycore_py.launch.run_program", str(mapfile.absolute())),
            stdin=subprocess.PIPE,
            stdout=subprocess.PIPE,
            start_new_session=True,  # Ctrl-C is for this process, which then stops the run
        )
        self._listener = threading.Thread(target=self._listen, daemon=True)
        self._listener.start()
        try:
            self._told.wait()
        except BaseException:
            self.stop()
            raise
        if not self._is_up:
            self._fail()

    @property
    def platform(self) -> str:
        """Name of the platform of the nodes."""
        return self._platform

    @property
    def pid(self) -> int:
        """Process id of the supervisor."""
        return self._process.pid

    @property
    def nodes(self) -> tuple[NodeStatus, ...]:
        """State of each process started so far, in start order."""
        return tuple(self._nodes.values())

    def wait(self, timeout_s: float | None = None) -> int | None:
        """Wait until all nodes have ended by themselves.

        :param timeout_s: in seconds; None waits indefinitely.
        :return: 0, or 1 if a node has failed; None on timeout.
        :raises Exception: any exception that `on_output` raised.
        """
        try:
            self._process.wait(timeout_s)
        except subprocess.TimeoutExpired:
            return None
        self._listener.join()
        return self._exit_status()

    def stop(self) -> int:
        """Stop the nodes: SIGINT, after 5 s SIGTERM, after 3 s more SIGKILL; then the platform.

        :return: 0, or 1 if a node has failed.
        :raises Exception: any exception that `on_output` raised.
        """
        self._process.send_signal(signal.SIGINT)
        self._process.wait()
        self._listener.join()
        return self._exit_status()

    def __enter__(self) -> Self:
        return self

    def __exit__(self, *_: object) -> None:
        self.stop()

    def _exit_status(self) -> int:
        assert self._process.stdin is not None
        assert self._process.stdout is not None
        self._process.stdin.close()
        self._process.stdout.close()
        error, self._error = self._error, None
        if error is not None:
            raise error
        if self._process.returncode < 0:
            raise ManycoreError(f"the supervisor of platform '{self._platform}' was killed")
        return self._process.returncode

    def _fail(self) -> None:
        self.stop()
        failed = ", ".join(f"{n.name} {n.reason}" for n in self.nodes if n.state == "failed")
        raise ManycoreError(
            "the run ended before all its nodes were started" + (f": {failed}" if failed else "")
        )

    def _listen(self) -> None:
        """Read the supervisor's events until it ends; runs in a separate thread."""
        assert self._process.stdout is not None
        for line in self._process.stdout:
            try:
                self._note(json.loads(line))
            except Exception as error:  # of the caller's function: raised where it is waited
                self._error = self._error or error
                self._on_output = None
        self._told.set()

    def _note(self, data: dict[str, Any]) -> None:
        kind = data.get("event")
        if kind == "output":
            if self._on_output is not None:
                self._on_output(data["node"], data["line"])
        elif kind == "up":
            self._is_up = True
            self._told.set()
        elif "error" in data:
            self._error = ManycoreError(data["error"], data["exit_status"])
        elif (event := event_of(data)) is not None:
            self._take(event)

    def _take(self, event: Event) -> None:
        if isinstance(event, Platform):
            self._platform = event.name
        elif isinstance(event, Started):
            place = (event.cluster, event.core, event.host_cpu)
            self._nodes[event.node] = NodeStatus(event.node, event.pid, *place)
        elif isinstance(event, Ended) and event.node in self._nodes:
            state: Literal["finished", "failed"] = (
                "failed" if event.state == "failed" else "finished"
            )
            known = self._nodes[event.node]
            self._nodes[event.node] = replace(known, state=state, reason=event.reason)


def run(mapfile: Mapfile | Path | str, *, on_output: OnOutput | None = None) -> ActiveRun:
    """Start the nodes of a mapfile, each on its core, as `manycore run` does.

    Returns once all nodes without a delayed start have been started. A separate supervisor process
    watches them; `manycore logs` shows their output.

    :param mapfile: a file, or the result of `load_mapfile`; the supervisor reads the file again.
    :param on_output: called in a separate thread with node name and line, for each line that a
        node prints.
    :raises MapfileError: if the mapfile is invalid.
    :raises ManycoreError: if the platform is running already, or a node cannot be started.
    """
    loaded = mapfile if isinstance(mapfile, Mapfile) else load_mapfile(mapfile)
    resolve(loaded)  # the supervisor could report the problem, but not its line
    return ActiveRun(loaded.path, on_output)
