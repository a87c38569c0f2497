# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""Asks the supervisor of a run for something."""

from __future__ import annotations

import select
import socket
import time
from collections.abc import Iterator
from types import TracebackType
from typing import Any

from typing_extensions import Self

from rmw_manycore_py.errors import ManycoreError
from rmw_manycore_py.runs.directory import RunDirectory
from rmw_manycore_py.runs.lines import LineBuffer, Message, encoded

# A supervisor answers at once, unless it was stopped or its machine has no time for it.
ANSWER_TIMEOUT_S = 10.0
# One that lives and does not listen yet, or no more, comes up or goes.
_LISTEN_TIMEOUT_S = 5.0
_LISTEN_PAUSE_S = 0.02


class Client:
    """A connection to a supervisor that begins with one request."""

    def __init__(self, run: RunDirectory, do: str, **arguments: Any) -> None:
        self._run = run
        self._lines = LineBuffer()
        self.socket = _connected(run)
        self._messages: list[Message] = []
        try:
            self.say({"do": do, **arguments})
            first = self._next()
        except BaseException:
            self.close()
            raise
        if first is None:
            self.close()
            raise ManycoreError(f"the run of platform '{run.platform}' ended before it answered")
        if "error" in first:
            self.close()
            raise ManycoreError(str(first["error"]))
        self.answer = first
        self.socket.settimeout(None)

    def __enter__(self) -> Self:
        return self

    def __exit__(
        self,
        kind: type[BaseException] | None,
        error: BaseException | None,
        traceback: TracebackType | None,
    ) -> None:
        self.close()

    def close(self) -> None:
        """Close the connection."""
        self.socket.close()

    def say(self, message: Message) -> None:
        """Send a message; one that nobody reads any more is lost."""
        try:
            self.socket.sendall(encoded(message))
        except TimeoutError as error:
            raise self._silent() from error
        except (BrokenPipeError, ConnectionResetError):
            pass  # what it said before is still to be read

    def messages(self) -> Iterator[Message]:
        """Yield what comes until the supervisor closes the connection, or is gone."""
        while (message := self._next()) is not None:
            yield message

    def early(self) -> list[Message]:
        """Return what came together with the answer: the socket does not become readable for it."""
        early, self._messages = self._messages, []
        return early

    def take(self, patience_s: float | None = None) -> list[Message] | None:
        """Return what comes next, within a time if one is given; None at the end."""
        if early := self.early():
            return early
        readable, _, _ = select.select([self.socket], [], [], patience_s)
        data = self._receive() if readable else b""
        return self._lines.take(data) if data else None

    def _next(self) -> Message | None:
        while not self._messages:
            data = self._receive()
            if not data:
                return None
            self._messages = self._lines.take(data)
        return self._messages.pop(0)

    def _receive(self) -> bytes:
        try:
            return self.socket.recv(1 << 16)
        except TimeoutError as error:
            raise self._silent() from error
        except ConnectionResetError:
            return b""

    def _silent(self) -> ManycoreError:
        pid = self._run.info.get("pid", "unknown")
        return ManycoreError(
            f"the supervisor of platform '{self._run.platform}' (pid {pid}) has not answered for "
            f"{ANSWER_TIMEOUT_S:g} s: is it stopped? kill -CONT {pid}"
        )


def _connected(run: RunDirectory) -> socket.socket:
    deadline = time.monotonic() + _LISTEN_TIMEOUT_S
    while True:
        try:
            return run.connect(ANSWER_TIMEOUT_S)
        except TimeoutError as error:
            raise ManycoreError(f"{run.path}: the supervisor does not answer") from error
        except OSError as error:
            if not run.is_alive:
                raise ManycoreError(f"the run of platform '{run.platform}' has ended") from error
            if time.monotonic() > deadline:
                raise ManycoreError(f"{run.path}: {error.strerror}") from error
        time.sleep(_LISTEN_PAUSE_S)
