# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""Virtual time of a run: the native timekeeper, and what its processes need to live in its time."""

from __future__ import annotations

import os
import subprocess
import sys
from collections.abc import Iterator, Mapping
from contextlib import ExitStack, contextmanager, suppress
from dataclasses import dataclass
from pathlib import Path

from rmw_manycore_program import own_program
from rmw_manycore_py.errors import ManycoreError
from rmw_manycore_py.launch.events import Held, Notice
from rmw_manycore_py.mapfile.placing.placement import Placement
from rmw_manycore_py.platform.virtual_clock import announced
from rmw_manycore_py.process.parent_death import dies_with_this_process

_PROGRAM = "lib/rmw_manycore/manycore_timekeeper"
_LIBRARY = "lib/rmw_manycore/libmanycore_virtual_time.so"
_NS_PER_S = 1_000_000_000
_MAX_DURATION_S = 1e9  # its nanoseconds fit with the time that has passed


@dataclass(frozen=True)
class PlatformModel:
    """Model of the time that callbacks take: a profile, on a platform as of `manycore simulate`."""

    mapfile: Path
    profile: Path
    platform: str
    seed: int


@dataclass(frozen=True)
class VirtualTime:
    """How a run keeps virtual time.

    :param factor: virtual seconds per second of CPU time of a callback; 0: callbacks take none.
    :param model: of the time that they take instead.
    :param kills: nodes to kill, each after a number of virtual seconds.
    """

    factor: float
    model: PlatformModel | None = None
    kills: tuple[tuple[str, float], ...] = ()


@dataclass(frozen=True)
class TimekeeperReport:
    """What the timekeeper reports.

    :ivar kind: `end` after the duration, `still` or `held` with why, `broken` if time ended early,
        `killed` with the rank of a program that is about to be killed as asked, `due` with that of
        one to be started: time stands until it has joined, or is gone.
    """

    kind: str
    text: str

    @property
    def event(self) -> Held | Notice | None:
        """What the user learns while the run goes on."""
        at, _, why = self.text.partition(" ")
        if self.kind == "held":
            return Held(int(at) / 1e9, why)
        if self.kind == "still":
            return Notice(f"time stands still at {int(at) / 1000} s: {why}")
        return None


class Timekeeper:
    """The process that keeps the virtual time of a run. Told of each program by its rank."""

    def __init__(self, process: subprocess.Popen[bytes], page: str, library: str) -> None:
        self._process = process
        self._page = page
        self._library = library
        self._unfinished = b""

    def environment(self, base: Mapping[str, str], rank: int) -> dict[str, str]:
        """Return `base` for a program to live in virtual time, with a fixed order of sets."""
        preloaded = [self._library, base.get("LD_PRELOAD", "")]
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
            self._process.wait()
            yield TimekeeperReport("ended", "the timekeeper has ended")
            return
        *lines, self._unfinished = (self._unfinished + data).split(b"\n")
        for line in lines:
            kind, _, text = line.decode(errors="replace").partition(" ")
            yield TimekeeperReport(kind, "the duration is over" if kind == "end" else text)

    def started(self, rank: int, pid: int, name: str) -> None:
        """Tell that a program's process exists: time stands until it has joined."""
        self._tell(f"start {rank} {pid} {name}")

    def gone(self, rank: int) -> None:
        """Tell that a program has ended and is not started again."""
        self._tell(f"gone {rank}")

    def start_in(self, rank: int, delay_s: float) -> None:
        """Tell that a program, which does not run, is due when virtual time has passed."""
        self._tell(f"later {rank} {round(delay_s * _NS_PER_S)}")

    def kill(self, rank: int, after_s: float) -> None:
        """Kill a program when virtual time has passed."""
        self._tell(f"kill {rank} {round(after_s * _NS_PER_S)}")

    def begin(self, duration_s: float | None) -> None:
        """Tell that all programs were started; time begins, and ends after `duration_s`."""
        self._tell(f"go {_duration_ns(duration_s)}")

    def hold(self) -> None:
        """Let time stand until it is resumed."""
        self._tell("hold")

    def resume(self, duration_s: float | None, topic: str, is_single: bool) -> None:
        """Let time go on: for a duration, until a message on a topic, or to what is due next."""
        self._tell(f"resume {-1 if is_single else _duration_ns(duration_s)} {topic}")

    def end(self) -> None:
        """Let time go on at the pace of the wall clock: the nodes are stopping."""
        self._tell("over")

    def _tell(self, line: str) -> None:
        assert self._process.stdin is not None
        with suppress(BrokenPipeError):  # its end is reported
            self._process.stdin.write(f"{line}\n".encode())


def _duration_ns(duration_s: float | None) -> int:
    """Return 0 for a duration without end, and for one of more than 31 years."""
    if duration_s is None or duration_s > _MAX_DURATION_S:
        return 0
    return round(duration_s * _NS_PER_S)


@contextmanager
def timekeeper(platform: str, mode: VirtualTime) -> Iterator[Timekeeper]:
    """Start the timekeeper of a platform that exists; end it after the block."""
    with ExitStack() as stack:
        library = stack.enter_context(_preloadable(sys.prefix, _LIBRARY))
        pipes = () if mode.model is None else stack.enter_context(_model(mode.model))
        process = stack.enter_context(
            subprocess.Popen(
                [f"{sys.prefix}/{_PROGRAM}", platform, str(mode.factor), *map(str, pipes)],
                stdin=subprocess.PIPE,
                stdout=subprocess.PIPE,
                bufsize=0,
                pass_fds=pipes,
                start_new_session=True,
                preexec_fn=dies_with_this_process(),
            )
        )
        assert process.stdout is not None
        first = b""
        while not first.endswith(b"\n") and (byte := process.stdout.read(1)):
            first += byte
        if not first.startswith(b"page "):
            raise ManycoreError("the timekeeper of virtual time did not start")
        page = first.decode().split()[1]
        try:
            with announced(platform, page):
                yield Timekeeper(process, page, library)
        finally:
            process.kill()


@contextmanager
def _preloadable(prefix: str, library: str) -> Iterator[str]:
    """Yield the path of a library for LD_PRELOAD, which splits at spaces and colons."""
    if not set(prefix) & set(" :$"):
        yield f"{prefix}/{library}"
        return
    directory = os.open(prefix, os.O_PATH | os.O_DIRECTORY)
    try:
        yield f"/proc/{os.getpid()}/fd/{directory}/{library}"
    finally:
        os.close(directory)


@contextmanager
def _model(model: PlatformModel) -> Iterator[tuple[int, int]]:
    """Start the model of a platform; yield descriptors to it and from it, for the timekeeper."""
    arguments = (str(model.mapfile), str(model.profile), model.platform, str(model.seed))
    with subprocess.Popen(
        own_program("rmw_manycore_py.prediction.live", *arguments),
        stdin=subprocess.PIPE,
        stdout=subprocess.PIPE,
        bufsize=0,
        start_new_session=True,
        preexec_fn=dies_with_this_process(),
    ) as process:
        assert process.stdin is not None
        assert process.stdout is not None
        try:
            yield process.stdin.fileno(), process.stdout.fileno()
        finally:
            process.kill()


def closed_notices(placement: Placement) -> tuple[str, ...]:
    """Return what the user should know of a placement that runs in virtual time."""
    if placement.bridge is None:
        return ()
    return ("virtual time: the bridge, which lives in wall time, stays closed",)
