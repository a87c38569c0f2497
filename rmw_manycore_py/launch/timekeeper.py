# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""Virtual time of a run: the native timekeeper, and what its processes need to live in its time."""

from __future__ import annotations

import os
import subprocess
import sys
from collections.abc import Iterator, Mapping
from contextlib import contextmanager, suppress
from dataclasses import dataclass

from rmw_manycore_py.errors import ManycoreError
from rmw_manycore_py.mapfile.placing.placement import Placement
from rmw_manycore_py.process.parent_death import dies_with_this_process

_PROGRAM = "lib/rmw_manycore/manycore_timekeeper"
_LIBRARY = "lib/rmw_manycore/libmanycore_virtual_time.so"
_NS_PER_S = 1_000_000_000


@dataclass(frozen=True)
class VirtualTime:
    """How a run keeps virtual time.

    :param factor: virtual seconds per second of CPU time of a callback; 0: callbacks take none.
    """

    factor: float


@dataclass(frozen=True)
class TimekeeperReport:
    """What the timekeeper reports: `end` after the duration, or why time stands `still`."""

    kind: str
    text: str


class Timekeeper:
    """The process that keeps the virtual time of a run. Told of each program by its rank."""

    def __init__(self, process: subprocess.Popen[bytes], page: str) -> None:
        self._process = process
        self._page = page
        self._unfinished = b""

    def environment(self, base: Mapping[str, str], rank: int) -> dict[str, str]:
        """Return `base` for a program to live in virtual time, with a fixed order of sets."""
        preloaded = [f"{sys.prefix}/{_LIBRARY}", base.get("LD_PRELOAD", "")]
        return {
            "PYTHONHASHSEED": "0",
            **base,
            "LD_PRELOAD": ":".join(path for path in preloaded if path),
            "MANYCORE_VIRTUAL_TIME": self._page,
            "MANYCORE_VIRTUAL_RANK": str(rank),
        }

    def fileno(self) -> int:
        """Return the descriptor that has reports."""
        assert self._process.stdout is not None
        return self._process.stdout.fileno()

    def read_reports(self) -> Iterator[TimekeeperReport]:
        """Yield what it has reported; `ended` if it ended, which it does only when told."""
        data = os.read(self.fileno(), 65536)
        if not data:
            yield TimekeeperReport("ended", f"status {self._process.wait()}")
            return
        *lines, self._unfinished = (self._unfinished + data).split(b"\n")
        for line in lines:
            kind, _, text = line.decode(errors="replace").partition(" ")
            yield TimekeeperReport(kind, text)

    def started(self, rank: int, pid: int, name: str) -> None:
        """Tell that a program's process exists: time stands until it has joined."""
        self._tell(f"start {rank} {pid} {name}")

    def gone(self, rank: int) -> None:
        """Tell that a program has ended and is not started again."""
        self._tell(f"gone {rank}")

    def begin(self, duration_s: float | None) -> None:
        """Tell that all programs were started; time begins, and ends after `duration_s`."""
        self._tell(f"go {round((duration_s or 0) * _NS_PER_S)}")

    def end(self) -> None:
        """Let time go on at the pace of the wall clock: the nodes are stopping."""
        self._tell("over")

    def _tell(self, line: str) -> None:
        assert self._process.stdin is not None
        with suppress(BrokenPipeError):  # its end is reported
            self._process.stdin.write(f"{line}\n".encode())


@contextmanager
def timekeeper(platform: str, mode: VirtualTime) -> Iterator[Timekeeper]:
    """Start the timekeeper of a platform that exists; end it after the block."""
    with subprocess.Popen(
        [f"{sys.prefix}/{_PROGRAM}", platform, str(mode.factor)],
        stdin=subprocess.PIPE,
        stdout=subprocess.PIPE,
        bufsize=0,
        start_new_session=True,
        preexec_fn=dies_with_this_process(),
    ) as process:
        assert process.stdout is not None
        first = b""
        while not first.endswith(b"\n") and (byte := process.stdout.read(1)):
            first += byte
        if not first.startswith(b"page "):
            raise ManycoreError("the timekeeper of virtual time did not start")
        try:
            yield Timekeeper(process, first.decode().split()[1])
        finally:
            process.kill()


def closed_notices(placement: Placement) -> tuple[str, ...]:
    """Return what the user should know of a placement that runs in virtual time."""
    if placement.bridge is None:
        return ()
    return ("virtual time: the bridge, which lives in wall time, stays closed",)
