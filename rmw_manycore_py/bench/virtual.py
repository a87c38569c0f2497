# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""Runs of a mapfile in virtual time, and whether they are the same."""

from __future__ import annotations

import hashlib
import json
import os
import re
import signal
import subprocess
import time
from collections.abc import Iterator, Sequence
from contextlib import ExitStack, contextmanager
from dataclasses import dataclass
from pathlib import Path
from tempfile import TemporaryDirectory

from rmw_manycore_program import own_program
from rmw_manycore_py.bench.load import busy
from rmw_manycore_py.errors import ManycoreError
from rmw_manycore_py.native import _transport
from rmw_manycore_py.trace.events import Kind, Trace, endpoint_id
from rmw_manycore_py.trace.files import load

CONDITIONS = ("alone", "beside busy loops", "on one CPU")
_LOOPS = 3
_MAX_POLL_S = 2e6  # of poll(), 2^31 ms
_STAMP = re.compile(r"\[(\d{10})\.(\d{9})\]")
_LOGGED = {Kind.WRITE: "publishes", Kind.RELEASE: "takes"}


@dataclass(frozen=True)
class VirtualRun:
    """A run in virtual time.

    :ivar printed: by nodes.
    :ivar messages: what nodes published and took, with the virtual time of each.
    :ivar trace: its events.
    :ivar wall_s: from the start of the command to its end.
    """

    condition: str
    printed: tuple[str, ...]
    messages: tuple[str, ...]
    trace: Trace
    wall_s: float

    @property
    def log(self) -> tuple[str, ...]:
        """What runs have in common."""
        return self.printed + self.messages

    @property
    def published(self) -> int:
        """Number of messages."""
        return sum(" publishes " in line for line in self.messages)

    @property
    def taken(self) -> int:
        """Number of takes."""
        return len(self.messages) - self.published

    @property
    def lost(self) -> int:
        """Messages that a full queue lost."""
        return sum(
            int(thread.events["value"][thread.events["kind"] == Kind.LOST].sum())
            for _, thread in self.trace.threads()
        )

    @property
    def digest(self) -> str:
        """Hash of the log."""
        return hashlib.sha256("\n".join(self.log).encode()).hexdigest()


def runs_of(
    mapfile: Path, options: Sequence[str], count: int, duration_s: float, timeout_s: float
) -> Iterator[VirtualRun]:
    """Yield runs under each condition in turn.

    :param options: of `manycore run`: how long callbacks take.
    :param timeout_s: wall time of a run.
    :raises ManycoreError: if a run fails, or does not end.
    """
    for number in range(count):
        condition = CONDITIONS[number % len(CONDITIONS)]
        with TemporaryDirectory() as directory, _under(condition, timeout_s):
            path = Path(directory) / "trace.csv"
            words = ("run", str(mapfile), "--virtual", *options, "--json")
            length = ("--duration", f"{duration_s:g}", "--trace", str(path))
            begin_s = time.monotonic()
            output = _output_of(own_program("rmw_manycore_py.cli", *words, *length), timeout_s)
            wall_s = time.monotonic() - begin_s
            trace = load(path)
            if trace.lost:
                raise ManycoreError(f"{trace.lost} events are missing, as rings were full")
            end_ns = _transport.virtual_start_ns + round(duration_s * 1e9)
            seen = tuple(_printed(output, end_ns)), tuple(_messages(trace, end_ns))
            yield VirtualRun(condition, *seen, trace, wall_s)


@contextmanager
def _under(condition: str, timeout_s: float) -> Iterator[None]:
    cpus = sorted(os.sched_getaffinity(0))
    with ExitStack() as stack:
        if condition == "beside busy loops":
            stack.enter_context(busy(_LOOPS, cpus, timeout_s))
        elif condition == "on one CPU":
            stack.callback(os.sched_setaffinity, 0, cpus)
            os.sched_setaffinity(0, cpus[:1])
        yield


def _output_of(command: Sequence[str], timeout_s: float) -> str:
    process = subprocess.Popen(command, stdout=subprocess.PIPE, text=True)
    try:
        output, _ = process.communicate(timeout=min(timeout_s, _MAX_POLL_S))
    except subprocess.TimeoutExpired as error:
        process.send_signal(signal.SIGINT)
        output, _ = process.communicate()
        notices = [one["text"] for one in _events(output) if one["event"] == "notice"]
        why = f": {notices[-1]}" if notices else ""
        raise ManycoreError(f"the run did not end within {timeout_s:g} s{why}") from error
    if process.returncode:
        last = [f": {one['line']}" for one in _events(output) if one["event"] == "output"][-1:]
        raise ManycoreError(f"the run failed with exit status {process.returncode}{''.join(last)}")
    return output


def _events(output: str) -> Iterator[dict[str, str]]:
    return map(json.loads, output.splitlines())


def _printed(output: str, end_ns: int) -> list[str]:
    """Return the lines of each node; those of several nodes mix by chance.

    What nodes log after the end is of the wall clock, with what rcl says of it: by their endings,
    one after the other.
    """
    lines: dict[str, list[str]] = {}
    ended = set[str]()
    for event in _events(output):
        if event["event"] == "output":
            if _stamp_ns(event["line"]) > end_ns:
                ended.add(event["node"])
            if event["node"] not in ended:
                lines.setdefault(event["node"], []).append(event["line"])
    return [f"{node} prints {line}" for node in sorted(lines) for line in lines[node]]


def _stamp_ns(line: str) -> int:
    """Return the time of a line of a ROS logger, or 0."""
    found = _STAMP.search(line)
    return int(found[1]) * 1_000_000_000 + int(found[2]) if found else 0


def _messages(trace: Trace, end_ns: int) -> list[str]:
    found = []
    for process, thread in trace.threads():
        if process.is_receive_thread:
            continue
        for time_ns, number, _, slot, incarnation, kind in thread.events.tolist():
            if kind in _LOGGED and time_ns <= end_ns:
                endpoint = endpoint_id(slot, incarnation)
                node = trace.node_of(endpoint).removesuffix(f"_{process.pid}")
                topic = trace.topic_of(endpoint)
                found.append(f"{time_ns} {node} {_LOGGED[kind]} {topic} {number}")
    return sorted(found)
