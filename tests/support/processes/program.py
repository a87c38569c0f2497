# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""Starting real programs and waiting for what they print."""

from __future__ import annotations

import re
import signal
import subprocess
import threading
import time
from collections.abc import Iterable
from pathlib import Path

from rmw_manycore_py.launch.processes.ending import is_rclpys
from support import TESTS, TIMEOUT_S
from support.peers.client import ForkedPeer, has_server


def _started(
    command: list[str], env: dict[str, str], directory: Path
) -> subprocess.Popen[str] | ForkedPeer:
    if has_server(command, env):
        return ForkedPeer(command, env)
    return subprocess.Popen(
        command,
        env=env,
        cwd=directory,
        text=True,
        errors="replace",
        stdin=subprocess.PIPE,
        stdout=subprocess.PIPE,
        stderr=subprocess.STDOUT,
    )


class Program:
    """A started process; its output, standard error included, is read line by line.

    It starts in TESTS: in the repository, `python -m` would import the sources there.
    """

    def __init__(
        self, command: Iterable[str | Path], env: dict[str, str], directory: Path = TESTS
    ) -> None:
        self.command = [str(word) for word in command]
        self.lines: list[str] = []
        self._next_line = 0
        self._ended = False
        self._changed = threading.Condition()
        self._process = _started(self.command, env, directory)
        self._reader = threading.Thread(target=self._read, daemon=True)
        self._reader.start()

    def _read(self) -> None:
        assert self._process.stdout is not None
        for line in self._process.stdout:
            with self._changed:
                self.lines.append(line.rstrip("\n"))
                self._changed.notify_all()
        with self._changed:
            self._ended = True
            self._changed.notify_all()

    @property
    def pid(self) -> int:
        return self._process.pid

    @property
    def output(self) -> str:
        return "\n".join(self.lines)

    def __repr__(self) -> str:
        return f"{' '.join(self.command)} (exit status {self._process.poll()}):\n{self.output}"

    def wait_for(self, pattern: str, timeout_s: float = TIMEOUT_S) -> re.Match[str]:
        """Return the match in the next matching line; earlier lines are then discarded."""
        deadline = time.monotonic() + timeout_s
        with self._changed:
            while True:
                while self._next_line < len(self.lines):
                    self._next_line += 1
                    if match := re.search(pattern, self.lines[self._next_line - 1]):
                        return match
                left_s = deadline - time.monotonic()
                if self._ended or not self._changed.wait(max(left_s, 0)):
                    raise AssertionError(f"no line matches {pattern!r} in the output of {self}")

    def skip_output(self) -> None:
        """Discard everything printed so far."""
        with self._changed:
            self._next_line = len(self.lines)

    def say(self, line: str) -> None:
        """Write a line to the program's standard input."""
        assert self._process.stdin is not None
        self._process.stdin.write(line + "\n")
        self._process.stdin.flush()

    def close_input(self) -> None:
        """Close the program's standard input."""
        assert self._process.stdin is not None
        self._process.stdin.close()

    def signal(self, number: signal.Signals) -> None:
        self._process.send_signal(number)

    def is_running(self) -> bool:
        return self._process.poll() is None

    def wait(self, timeout_s: float = TIMEOUT_S) -> int:
        """Return the exit status, once all output has been read."""
        try:
            status = self._process.wait(timeout_s)
        except subprocess.TimeoutExpired:
            raise AssertionError(f"still running after {timeout_s:g} s: {self}") from None
        self._reader.join(timeout_s)
        return status

    def stop(self) -> int:
        """Send SIGINT, as Ctrl-C does; return the exit status."""
        self.signal(signal.SIGINT)
        return self.wait()

    def stop_node(self) -> bool:
        """Send SIGINT to a plain rclpy node; return whether it ended quietly, if rclpy lets it.

        rclpy turns some interrupts into an error of its own.
        """
        status = self.stop()
        return status == 0 or (status == 1 and is_rclpys(self.lines[-20:]))

    def kill(self) -> None:
        """Kill the program, whatever its state, and close our ends of its pipes."""
        self._process.kill()
        self._process.wait()
        self._reader.join()
        for stream in (self._process.stdin, self._process.stdout):
            assert stream is not None
            stream.close()
