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
_HANDLE = re.compile(rb" \w+ = 0x([0-9A-F]+)")
_BUFFER = 1 << 20  # bytes; the usual 8 KiB cost more wake-ups than work
_PREFIXES = ("ros2:", "ros2_caret:")


class ThreadId(NamedTuple):
    """A thread that recorded events."""

    pid: int
    tid: int


class Event(NamedTuple):
    """An event of ros2_tracing or CARET."""

    time_ns: int
    name: str
    thread: ThreadId
    handle: int  # in the first field; 0 if that is no address
    payload: bytes

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
            subprocess.Popen(
                command, bufsize=_BUFFER, stdout=subprocess.PIPE, stderr=log
            ) as program,
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
        """Parse lines such as `[1.5] host ros2:x: { cpu_id = 1 }, { vpid = 2 }, { y = 0x3 }`."""
        threads: dict[bytes, ThreadId] = {}
        names: dict[bytes, str] = {}
        for line in lines:
            parts = line.split(b"}, {", 2)
            head = parts[0].split(b": {", 1)[0]
            own_name = head[head.rfind(b" ") + 1 :]
            name = names.get(own_name)
            if name is None:
                name = names[own_name] = own_name.decode()
            if not name.startswith(_PREFIXES):
                continue
            if len(parts) != 3:
                raise self._problem(f"event {name}", "its context and fields")
            _, context, payload = parts
            thread = threads.get(context)
            if thread is None:
                thread = threads[context] = self._thread(context)
            time_ns = int(head[1 : head.index(b"]")].replace(b".", b""))
            found = _HANDLE.match(payload)
            yield Event(time_ns, name, thread, int(found[1], 16) if found else 0, payload)

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
