# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""Run a command and show its progress: progress.py LOG WHAT COMMAND [ARGUMENT..].

WHAT describes the command ("installing Python packages") and precedes the current step: a step of
ninja or a package of pip. A terminal shows one updating line, otherwise lines are printed now and
then. All output goes to LOG; if the command fails, its error lines are printed.
"""

from __future__ import annotations

import re
import subprocess
import sys
import time
from pathlib import Path

NINJA_STEP = re.compile(r"^\s*\[([1-9]\d*)/(\d+)\] ")
PIP_PACKAGE = re.compile(r"^\s*(?:Collecting|Requirement already satisfied:) ([\w.-]+)")
PIP_DOWNLOAD = re.compile(r"^\s*Downloading (\S+?)-\d\S* \(([\d.]+ \w+)\)")
PIP_INSTALL = re.compile(r"^\s*Installing collected packages: (.*)")
# First lines of an error in the log.
FAILURE = re.compile(r"^\s*(FAILED: |CMake Error|ERROR: |error: )")
LAST_LINES = 30
QUIET_S = 15


class Progress:
    """Reports the progress of a command."""

    def __init__(self, what: str) -> None:
        self._what = what
        self._start_s = self._reported_s = time.monotonic()
        self._is_terminal = sys.stdout.isatty()
        self._packages: set[str] = set()
        self._print(what)

    def read(self, line: str) -> None:
        """Process a line of output."""
        if step := NINJA_STEP.match(line):
            self._report(f"{step[1]} of {step[2]}")
        elif package := PIP_PACKAGE.match(line):
            self._packages.add(package[1])
            self._report(f"{len(self._packages)} found")
        elif download := PIP_DOWNLOAD.match(line):
            self._report(f"{len(self._packages)} found, downloading {download[1]} ({download[2]})")
        elif install := PIP_INSTALL.match(line):
            self._report(f"unpacking {len(install[1].split(','))}")

    def end(self, verdict: str) -> None:
        """Print the result."""
        seconds = time.monotonic() - self._start_s
        self._print(f"{self._what}: {verdict} in {seconds:.0f} s")
        if self._is_terminal:
            print(flush=True)

    def _report(self, how_far: str) -> None:
        now_s = time.monotonic()
        if self._is_terminal or now_s - self._reported_s > QUIET_S:
            self._reported_s = now_s
            self._print(f"{self._what}: {how_far}")

    def _print(self, text: str) -> None:
        print(f"\r\033[K{text}" if self._is_terminal else text + "\n", end="", flush=True)


def failure(lines: list[str]) -> str:
    """Return the lines that explain why a command failed."""
    first = next((i for i, line in enumerate(lines) if FAILURE.match(line)), -LAST_LINES)
    return "".join(lines[first:])


def main(log: str, what: str, *command: str) -> int:
    """Run the command; return its exit status."""
    progress = Progress(what)
    with (
        Path(log).open("w") as file,
        subprocess.Popen(
            command, text=True, errors="replace", stdout=subprocess.PIPE, stderr=subprocess.STDOUT
        ) as process,
    ):
        assert process.stdout is not None
        for line in process.stdout:
            file.write(line)
            progress.read(line)
    progress.end("failed" if process.returncode else "done")
    if process.returncode:
        sys.stderr.write(failure(Path(log).read_text().splitlines(keepends=True)))
        sys.stderr.write(f"Full output: {log}\n")
    return process.returncode


if __name__ == "__main__":
    sys.exit(main(*sys.argv[1:]))
