# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""Client of a run's supervisor."""

from __future__ import annotations

import select
import socket
import time
from collections.abc import Iterator
from pathlib import Path
from typing import Any

from typing_extensions import Self

from rmw_manycore_py.errors import ManycoreError
from rmw_manycore_py.launch.runs.directory import RunDirectory
from rmw_manycore_py.launch.runs.lines import LineBuffer, Message, encoded

# A supervisor answers at once, unless it is stopped or the machine is overloaded.
ANSWER_TIMEOUT_S = 10.0
# A live supervisor that does not listen is starting or ending.
_LISTEN_TIMEOUT_S = 5.0
_LISTEN_PAUSE_S = 0.02


class Client:
    """Connection to a supervisor, opened with one request."""

    def __init__(self, run: RunDirectory, do: str, **arguments: Any) -> None:
        self._run = run
        self._lines = LineBuffer()
        if _is_stopped(run):
            raise ManycoreError(
                f"the supervisor of platform '{run.platform}' (pid {run.info['pid']}) is stopped "
                f"(SIGSTOP): `kill -CONT {run.info['pid']}` lets it go on"
            )
        self.socket = _connected(run)
        self._messages: list[Message] = []
        try:
            self.send({"do": do, **arguments})
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

    def __exit__(self, *_: object) -> None:
        self.close()

    def close(self) -> None:
        """Close the connection."""
        self.socket.close()

    def send(self, message: Message) -> None:
        """Send a message; it is lost if the supervisor has gone."""
        try:
            self.socket.sendall(encoded(message))
        except TimeoutError as error:
            raise self._silent() from error
        except (BrokenPipeError, ConnectionResetError):
            pass  # its earlier messages can still be read

    def messages(self) -> Iterator[Message]:
        """Yield messages until the supervisor closes the connection or ends."""
        while (message := self._next()) is not None:
            yield message

    def early(self) -> list[Message]:
        """Return messages received with the answer; the socket is not readable for those."""
        early, self._messages = self._messages, []
        return early

    def take(self, timeout_s: float | None = None) -> list[Message] | None:
        """Return the next messages, waiting up to `timeout_s` if given; None at the end."""
        if early := self.early():
            return early
        readable, _, _ = select.select([self.socket], [], [], timeout_s)
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
            f"{ANSWER_TIMEOUT_S:g} s: is it stopped? `kill -CONT {pid}`"
        )


def _is_stopped(run: RunDirectory) -> bool:
    try:
        stat = Path(f"/proc/{run.info['pid']}/stat").read_text()
    except (OSError, KeyError):  # it ends, or its processes are not visible here
        return False
    return run.is_alive and stat.rpartition(")")[2].split()[0] == "T"


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
