# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""Requests of other processes to a run, through its socket (docs/design/control.md)."""

from __future__ import annotations

import base64
import errno
import os
import socket
import struct
import time
from collections.abc import Iterable
from contextlib import suppress
from dataclasses import asdict
from typing import Any

from rmw_manycore_py.errors import ManycoreError
from rmw_manycore_py.launch.applying import Applier
from rmw_manycore_py.launch.connection import Connection
from rmw_manycore_py.launch.events import Ended, Event, Held, Output, Restarting
from rmw_manycore_py.launch.processes.node_process import NodeProcess
from rmw_manycore_py.launch.requests import (
    Apply,
    Attach,
    Follow,
    Move,
    Pause,
    Restart,
    Resume,
    State,
    Stop,
    Typing,
    request_of,
)
from rmw_manycore_py.launch.runner import Runner
from rmw_manycore_py.launch.runs.lines import Message, encoded

_CREDENTIALS = struct.Struct("3i")
# More than one person's shells; keeps file descriptors free for nodes.
MAX_CLIENTS = 64
# Places for further clients, which are only served if they ask to stop.
STOP_PLACES = 4
_FULL = (
    f"{MAX_CLIENTS} clients are connected to this run already: end some of them; "
    "`manycore stop` is still served"
)
_GOODBYE_S = 1.0


class Control:
    """Serves the clients of a run from the runner's event loop; never blocks."""

    def __init__(self, listener: socket.socket, runner: Runner, applier: Applier) -> None:
        self._listener = listener
        self._runner = runner
        self._applier = applier
        self._connections: list[Connection] = []
        self._stepping: Connection | None = None  # whose step of virtual time is under way
        self._spare = socket.socket()  # only a descriptor, for `_turn_away`
        runner.watch(listener, self._accept)

    def report(self, event: Event) -> None:
        """Forward an event to the clients that wait for it."""
        if isinstance(event, Output):
            return
        if isinstance(event, Held):
            self._stepping = None
        for connection in tuple(self._connections):
            if connection.wants_events:
                connection.send(event.as_data())
            elif connection.node is not None and connection.node == getattr(event, "node", None):
                if isinstance(event, Ended):
                    connection.finish({"ended": event.reason})
                elif isinstance(event, Restarting):
                    connection.send({"restarting": event.reason})

    def log_changed(self) -> None:
        """Wake clients that follow logs, unless they are already woken."""
        for connection in tuple(self._connections):
            if connection.follows_logs and connection.is_idle:
                connection.send({"log": True})

    def close(self) -> None:
        """Disconnect all clients."""
        self._applier.close()
        self._stepping = None
        self._runner.unwatch(self._listener)
        deadline_s = time.monotonic() + _GOODBYE_S
        for connection in tuple(self._connections):
            connection.say_goodbye(max(deadline_s - time.monotonic(), 0))
        self._spare.close()

    def _accept(self) -> None:
        try:
            client, _ = self._listener.accept()
        except OSError as error:
            if error.errno in (errno.EMFILE, errno.ENFILE):
                self._turn_away()
            return
        try:
            if not _is_allowed(client):
                client.close()
                return
            if len(self._connections) == MAX_CLIENTS + STOP_PLACES:
                self._connections[MAX_CLIENTS].finish({"error": _FULL})
            self._connections.append(Connection(client, self._runner, self._serve, self._forget))
        except OSError:  # the client has gone, or the selector has no room
            client.close()

    def _forget(self, connection: Connection) -> None:
        """Forget a client that has left; time stands if it was to stand for it."""
        self._connections.remove(connection)
        if connection is self._stepping:
            self._stepping = None
            if self._runner.timekeeper is not None and not self._runner.is_stopping:
                self._runner.timekeeper.hold()

    def _turn_away(self) -> None:
        """Refuse a client by the spare descriptor; queued, it would keep the loop awake."""
        self._spare.close()
        with suppress(OSError):
            client, _ = self._listener.accept()
            _refuse(client)
        with suppress(OSError):
            self._spare = socket.socket()

    def _serve(self, connection: Connection, message: Message) -> None:
        if connection.node is not None:
            _type(connection, Typing.of(message))
            return
        request = request_of(message)
        if not isinstance(request, Stop) and connection in self._connections[MAX_CLIENTS:]:
            raise ManycoreError(_FULL)
        match request:
            case State():
                connection.finish({"nodes": [_row(node) for node in self._runner.nodes]})
            case Stop():
                self._stop(connection, request)
            case Restart():
                self._restart(connection, request)
            case Apply() | Move():
                self._applier.begin(connection, request)
            case Pause() | Resume():
                self._keep_time(connection, request)
            case Follow():
                connection.send({})
                connection.follows_logs = True
            case Attach():
                self._attach(connection, request)

    def _stop(self, connection: Connection, request: Stop) -> None:
        names = _unique(request.nodes or ())
        nodes = [self._runner.node(name) for name in names]
        connection.send({"waits_for": [n.program.name for n in nodes if n.is_alive]})
        connection.wants_events = True
        if request.nodes is None:
            self._runner.stop_all("manycore stop")
        for name in names:
            self._runner.stop_node(name)

    def _restart(self, connection: Connection, request: Restart) -> None:
        names = _unique(request.nodes)
        for name in names:
            self._runner.node(name)  # check all names before stopping any
        connection.send({"waits_for": names})
        connection.wants_events = True
        for name in names:
            self._runner.restart_node(name, request.terminal)

    def _keep_time(self, connection: Connection, request: Pause | Resume) -> None:
        keeper = self._runner.timekeeper
        if keeper is None:
            raise ManycoreError(
                "the time of this run is the wall clock's: only that of `run --virtual` stops"
            )
        connection.wants_events = isinstance(request, Pause) or request.has_end
        self._stepping = None
        if isinstance(request, Pause):
            keeper.hold()
        else:
            keeper.resume(request.for_s, request.topic, request.single)
            self._stepping = connection if request.has_end else None
        if connection.wants_events:
            connection.send({})
        else:
            connection.finish({})

    def _attach(self, connection: Connection, request: Attach) -> None:
        node = self._runner.node(request.node)
        name = node.program.name
        if not node.program.terminal:
            raise ManycoreError(
                f"node '{name}' has no terminal: set `terminal: true` in the mapfile, or "
                f"restart it with one: `manycore attach --restart {name}`"
            )
        if not node.is_alive or node.is_leaderless:
            reason = f" ({node.ending.reason})" if node.ending else ""
            raise ManycoreError(
                f"node '{name}' is not running{reason}: `manycore restart {name}` starts it, "
                f"`manycore logs {name}` shows its output"
            )
        lines = "".join(f"{line}\r\n" for line in node.last_lines)
        connection.send({"output": base64.b64encode(lines.encode()).decode()})
        connection.attach(name)
        _type(connection, Typing(size=request.size))


def _refuse(client: socket.socket) -> None:
    """Refuse a client; it may be `manycore stop`, so the error names the signal that stops."""
    error = "the supervisor is out of file descriptors (ulimit -n)"
    with client:
        client.setblocking(False)
        client.send(encoded({"error": f"{error}; `kill {os.getpid()}` stops the run"}))


def _is_allowed(client: socket.socket) -> bool:
    credentials = client.getsockopt(socket.SOL_SOCKET, socket.SO_PEERCRED, _CREDENTIALS.size)
    return _CREDENTIALS.unpack(credentials)[1] in (os.geteuid(), 0)


def _type(connection: Connection, typing: Typing) -> None:
    if typing.input:
        connection.type(typing.input)
    if typing.size is not None:
        connection.resize(*typing.size)


def _unique(names: Iterable[str]) -> list[str]:
    return list(dict.fromkeys(names))


def _row(node: NodeProcess) -> dict[str, Any]:
    program, ending = node.program, node.ending
    return {
        "name": program.name,
        "state": node.state.value,
        "pid": node.process.pid if node.is_alive else None,
        "cluster": program.core.cluster,
        "core": program.core.core,
        "host_cpu": program.host_cpu,
        "respawns": node.respawns,
        "reason": ending.reason if ending else None,
        "exit_status": ending.exit_status if ending else None,
        "signal": ending.signal if ending else None,
        "terminal": program.terminal,
        "scheduling": asdict(program.scheduling) if program.scheduling else None,
    }
