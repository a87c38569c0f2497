# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""Events of an LTTng trace, read with the program babeltrace2.

Its Python module is built for the distribution's own Python only, so this reads its text.
"""

from __future__ import annotations

import re
import shutil
import subprocess
import tempfile
from collections.abc import Iterator
from dataclasses import dataclass, field
from pathlib import Path
from typing import IO, NamedTuple

from rmw_manycore_py.errors import FileError, ManycoreError, Problem

_FIELD = re.compile(rb'(\w+) = ("(?:[^"\\]|\\.)*"|[^,{}\s]+)')
_DISCARDED = re.compile(rb"Tracer discarded (\d+) event")
_LOGGED_ERROR = re.compile(rb"^\S+ \S+ +\d+ +\d+ E \S+ \S+@\S+:\d+ (?:\[[^\]]*\] )?(.*)$", re.M)
_PREFIXES = (b"ros2:", b"ros2_caret:")


class ThreadId(NamedTuple):
    """A thread that recorded events."""

    pid: int
    tid: int


class Event(NamedTuple):
    """An event of ros2_tracing or CARET; its fields are parsed when needed."""

    time_ns: int
    name: str
    thread: ThreadId
    payload: bytes

    @property
    def handle(self) -> int:
        """The address in the first field."""
        return int(self.payload.split(b",", 1)[0].split()[2], 16)

    def fields(self) -> dict[str, int | str]:
        """Return all fields."""
        return fields_in(self.payload)


@dataclass
class Reader:
    """Reads the events of a trace once, in order of time."""

    path: Path
    discarded: int = 0  # known at the end
    process_names: dict[int, str] = field(default_factory=dict)  # by pid

    def events(self) -> Iterator[Event]:
        """Yield the events of ros2_tracing and CARET.

        :raises ManycoreError: if babeltrace2 is missing; FileError if the trace is damaged.
        """
        command = [_program(), "--color=never", "--clock-seconds", "--no-delta", str(self.path)]
        with (
            tempfile.TemporaryFile() as log,
            subprocess.Popen(command, stdout=subprocess.PIPE, stderr=log) as program,
        ):
            try:
                assert program.stdout is not None
                yield from self._parsed(program.stdout)
            except BaseException:
                program.kill()
                raise
            status = program.wait()
            log.seek(0)
            self._check(status, log.read())

    def _parsed(self, lines: IO[bytes]) -> Iterator[Event]:
        threads: dict[bytes, ThreadId] = {}
        names: dict[bytes, str] = {}
        for line in lines:
            parts = line.split(b"}, {", 2)
            stamp, _, head = parts[0].partition(b" ")
            full_name = head.partition(b": {")[0].rpartition(b" ")[2]
            if not full_name.startswith(_PREFIXES):
                continue
            if len(parts) != 3:
                raise self._problem(f"event {full_name.decode()}", "its context and fields")
            thread = threads.get(parts[1])
            if thread is None:
                thread = threads[parts[1]] = self._thread(parts[1])
            name = names.setdefault(full_name, full_name.decode())
            time_ns = int(stamp[1:-1].replace(b".", b""))
            yield Event(time_ns, name, thread, parts[2])

    def _thread(self, context: bytes) -> ThreadId:
        fields = fields_in(context)
        pid, tid = fields.get("vpid"), fields.get("vtid")
        if not isinstance(pid, int) or not isinstance(tid, int):
            expected = "the context fields vpid and vtid (ros2 trace -c vpid vtid procname)"
            raise self._problem("events", expected, ", ".join(fields) or "none")
        self.process_names.setdefault(pid, str(fields.get("procname", "")))
        return ThreadId(pid, tid)

    def _check(self, status: int, log: bytes) -> None:
        self.discarded = sum(map(int, _DISCARDED.findall(log)))
        if status:
            found = _LOGGED_ERROR.search(log)
            text = found[1] if found else log.strip().rpartition(b"\n")[2]
            raise self._problem("", "a CTF trace", text.decode(errors="replace"))

    def _problem(self, key: str, expected: str, found: str = "none") -> FileError:
        return FileError(Problem(self.path, 0, key, expected, found))


def fields_in(text: bytes) -> dict[str, int | str]:
    """Return the fields in a text such as `callback = 0x55A0, symbol = "f()"`."""
    return {name.decode(): _value(value) for name, value in _FIELD.findall(text)}


def _value(text: bytes) -> int | str:
    if text.startswith(b'"'):
        return re.sub(rb"\\(.)", rb"\1", text[1:-1]).decode(errors="replace")
    try:
        return int(text, 0)
    except ValueError:
        return text.decode(errors="replace")


def _program() -> str:
    found = shutil.which("babeltrace2")
    if found is None:
        raise ManycoreError(
            "reading LTTng traces needs the program babeltrace2: apt-get install babeltrace2"
        )
    return found
