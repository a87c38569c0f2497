# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""Non-blocking connection of a supervisor to one client."""

from __future__ import annotations

import base64
import os
import socket
from collections.abc import Callable
from contextlib import suppress

from rmw_manycore_py.errors import ManycoreError
from rmw_manycore_py.launch.processes.terminal import set_size
from rmw_manycore_py.launch.runner import Runner
from rmw_manycore_py.launch.runs.lines import LineBuffer, Message, encoded

# A client that lags further behind is disconnected.
MAX_QUEUE_BYTES = 4 << 20


class Connection:
    """Receives requests and sends messages as far as the client reads them."""

    def __init__(
        self,
        client: socket.socket,
        runner: Runner,
        handle: Callable[[Connection, Message], None],
        closed: Callable[[Connection], None],
    ) -> None:
        client.setblocking(False)
        self._client = client
        self._runner = runner
        self._handle = handle
        self._closed = closed
        self._lines = LineBuffer()
        self._queue = bytearray()
        self._is_finished = False
        self._is_watched = True
        self.wants_events = False
        self.follows_logs = False
        self.node: str | None = None  # node that the client is attached to
        runner.watch(client, self._serve)

    @property
    def is_finished(self) -> bool:
        """Return whether the client gets no more messages."""
        return self._is_finished

    @property
    def is_idle(self) -> bool:
        """Return whether everything has been sent."""
        return not self._queue

    def send(self, message: Message) -> None:
        """Queue a message and send what fits."""
        if self._is_finished:
            return
        self._queue += encoded(message)
        self._flush()

    def finish(self, message: Message) -> None:
        """Send a last message, then close the connection."""
        self.send(message)
        self._is_finished = True
        if not self._queue:
            self.close()

    def attach(self, node: str) -> None:
        """Forward the output of a node from now on, unless the client has gone."""
        if self._is_finished:
            return
        self.node = node
        self._runner.taps[node].append(self._output)

    def type(self, data: bytes) -> None:
        """Type on the node's terminal; input beyond the terminal's buffer is lost."""
        terminal = self._terminal()
        if terminal is not None:
            with suppress(OSError):
                os.write(terminal, data)

    def resize(self, rows: int, columns: int) -> None:
        """Set the size of the node's terminal."""
        terminal = self._terminal()
        if terminal is not None:
            with suppress(OSError):
                set_size(terminal, rows, columns)

    def close(self) -> None:
        """Disconnect the client."""
        if not self._is_watched:
            return
        self._is_watched = False
        self._is_finished = True
        if self.node is not None:
            self._runner.taps[self.node].remove(self._output)
        self._runner.unwatch(self._client)
        self._client.close()
        self._closed(self)

    def say_goodbye(self, timeout_s: float) -> None:
        """Send queued messages at the end of the run, and close."""
        with suppress(OSError):
            self._client.settimeout(timeout_s)
            self._client.sendall(self._queue)
        self.close()

    def _terminal(self) -> int | None:
        if self.node is None:
            return None
        node = self._runner.node(self.node)
        return node.output.fileno() if node.is_alive and not node.output.at_end else None

    def _output(self, data: bytes) -> None:
        self.send({"output": base64.b64encode(data).decode()})

    def _serve(self) -> None:
        self._flush()
        if not self._is_watched:
            return
        try:
            data = self._client.recv(1 << 16)
        except BlockingIOError:
            return
        except OSError:
            data = b""
        if not data:
            self.close()
            return
        try:
            self._take(data)
        except ManycoreError as error:
            self.finish({"error": str(error)})
        except Exception as error:  # no client can end the run, whatever it sends
            self.finish({"error": f"the request failed: {type(error).__name__}: {error}"})

    def _take(self, data: bytes) -> None:
        """Handle requests; what follows the last one is ignored."""
        for message in () if self._is_finished else self._lines.take(data):
            if self._is_finished:
                break
            self._handle(self, message)

    def _flush(self) -> None:
        try:
            sent = self._client.send(self._queue) if self._queue else 0
        except BlockingIOError:
            sent = 0
        except OSError:
            self.close()
            return
        del self._queue[:sent]
        if len(self._queue) > MAX_QUEUE_BYTES or (self._is_finished and not self._queue):
            self.close()
            return
        self._runner.watch_also_writable(self._client, bool(self._queue))
