# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""Requests of other processes to a run, through its socket (docs/design/control.md)."""

from __future__ import annotations

import base64
import os
import socket
import struct
from collections.abc import Callable
from dataclasses import asdict
from typing import Any

from rmw_manycore_py.errors import ManycoreError
from rmw_manycore_py.launch.connection import Connection
from rmw_manycore_py.launch.events import Ended, Event, Output, Restarting
from rmw_manycore_py.launch.processes.node_process import NodeProcess
from rmw_manycore_py.launch.runner import Runner
from rmw_manycore_py.runs.lines import Message

_CREDENTIALS = struct.Struct("3i")


class Control:
    """Serves the clients of a run from the runner's event loop; never blocks."""

    def __init__(self, listener: socket.socket, runner: Runner) -> None:
        self._listener = listener
        self._runner = runner
        self._connections: list[Connection] = []
        self._requests: dict[str, Callable[[Connection, Message], None]] = {
            "state": self._state,
            "stop": self._stop,
            "restart": self._restart,
            "follow": self._follow,
            "attach": self._attach,
        }
        runner.watch(listener, self._accept)

    def report(self, event: Event) -> None:
        """Forward an event to the clients that wait for it."""
        if isinstance(event, Output):
            return
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
        self._runner.unwatch(self._listener)
        for connection in tuple(self._connections):
            connection.say_goodbye()

    def _accept(self) -> None:
        try:
            client, _ = self._listener.accept()
        except OSError:  # the client has gone, or out of file descriptors
            return
        size = _CREDENTIALS.size
        credentials = client.getsockopt(socket.SOL_SOCKET, socket.SO_PEERCRED, size)
        if _CREDENTIALS.unpack(credentials)[1] not in (os.geteuid(), 0):
            client.close()
            return
        connection = Connection(client, self._runner, self._serve, self._connections.remove)
        self._connections.append(connection)

    def _serve(self, connection: Connection, message: Message) -> None:
        if connection.node is not None:
            _use_terminal(connection, message)
            return
        request = self._requests.get(str(message.get("do")))
        if request is None:
            raise ManycoreError(f"unknown request {message.get('do')!r}")
        request(connection, message)

    def _state(self, connection: Connection, _message: Message) -> None:
        connection.finish({"nodes": [_row(node) for node in self._runner.nodes]})

    def _stop(self, connection: Connection, message: Message) -> None:
        names = _names(message)
        nodes = [self._runner.node(name) for name in names]
        connection.send({"waits_for": [n.program.name for n in nodes if n.is_alive]})
        connection.wants_events = True
        if not names:
            self._runner.stop_all("manycore stop")
        for name in names:
            self._runner.stop_node(name)

    def _restart(self, connection: Connection, message: Message) -> None:
        names = _names(message)
        for name in names:
            self._runner.node(name)  # check all names before stopping any
        connection.send({"waits_for": names})
        connection.wants_events = True
        for name in names:
            self._runner.restart_node(name, bool(message.get("terminal")))

    def _follow(self, connection: Connection, _message: Message) -> None:
        connection.send({})
        connection.follows_logs = True

    def _attach(self, connection: Connection, message: Message) -> None:
        node = self._runner.node(str(message.get("node")))
        name = node.program.name
        if not node.program.terminal:
            raise ManycoreError(
                f"node '{name}' has no terminal: set `terminal: true` in the mapfile, or "
                f"restart it with one: manycore attach --restart {name}"
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
        _use_terminal(connection, message)


def _use_terminal(connection: Connection, message: Message) -> None:
    if "input" in message:
        connection.type(base64.b64decode(str(message["input"])))
    if "size" in message:
        rows, columns = (max(0, min(int(number), 0xFFFF)) for number in message["size"])
        connection.resize(rows, columns)


def _names(message: Message) -> list[str]:
    return [str(name) for name in message.get("nodes") or ()]


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
