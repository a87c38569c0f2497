# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""Events as CSV with names, one per line, for spreadsheets and scripts."""

from __future__ import annotations

import csv
import json
from collections.abc import Iterator
from pathlib import Path
from typing import BinaryIO

import numpy as np

from rmw_manycore_py.errors import what_is_wrong
from rmw_manycore_py.trace.events import (
    EVENT,
    NO_ENDPOINT,
    Kind,
    Process,
    Thread,
    Trace,
    endpoint_id,
)
from rmw_manycore_py.trace.files.embedded import header_of, parsed_header, with_events, wrong
from rmw_manycore_py.trace.pairs import groups_of, split_by

_MARK = "# manycore trace "
_COLUMNS = (
    *("time_ns", "kind", "cluster", "core", "pid", "tid", "node", "topic"),
    *("endpoint", "incarnation", "number", "value"),
)
_PIECE = 100_000  # events written at a time
_NAMES = {kind.value: kind.name.lower() for kind in Kind}
_OF_NO_ENDPOINT = (Kind.RESUME, Kind.PASS)  # use the field differently
_NUMBERS = {name: number for number, name in _NAMES.items()}


def write(trace: Trace, file: BinaryIO) -> None:
    """Write the header as a comment, the column names, and the events by thread."""
    file.write(f"{_MARK}{json.dumps(header_of(trace))}\n{','.join(_COLUMNS)}\n".encode())
    for process, thread in trace.threads():
        for begin in range(0, len(thread.events), _PIECE):
            file.write(_lines(trace, process, thread, begin).encode())


def _lines(trace: Trace, process: Process, thread: Thread, begin: int) -> str:
    """Return some lines of a thread; formats common parts once."""
    events = thread.events[begin : begin + _PIECE]
    core = "" if process.core is None else str(process.core)
    place = f"{process.cluster},{core},{process.pid},{thread.tid}"
    sorts = groups_of(tuple(events[key] for key in ("kind", "endpoint", "incarnation")))
    texts = np.empty(len(events), object)
    for own in split_by(sorts):
        slot, incarnation, kind = events[own[0]].tolist()[3:]
        texts[own] = (
            f"{_NAMES.get(kind, kind)},{place},{_names_of(trace, kind, slot, incarnation)},"
            f"{slot},{incarnation}"
        )
    columns = (events["time_ns"], texts, events["number"], events["value"])
    rows = zip(*(column.tolist() for column in columns), strict=True)
    return "".join(map("%d,%s,%d,%d\n".__mod__, rows))


def _names_of(trace: Trace, kind: int, slot: int, incarnation: int) -> str:
    if slot == NO_ENDPOINT or kind in _OF_NO_ENDPOINT:
        return ","
    endpoint = endpoint_id(slot, incarnation)
    return f"{trace.node_of(endpoint)},{trace.topic_of(endpoint)}"


def read(content: bytes, path: Path) -> Trace:
    """Return the trace written by `write`."""
    try:
        lines = content.decode().splitlines()
    except UnicodeDecodeError as error:
        raise wrong(path, "", "a trace as text", what_is_wrong(error)) from error
    if len(lines) < 2 or not lines[0].startswith(_MARK) or lines[1] != ",".join(_COLUMNS):
        raise wrong(path, "", "a trace of manycore trace save", "a file of another program")
    if not content.endswith(b"\n"):
        raise wrong(path, "", "a whole trace", "a last line that is cut short")
    header = parsed_header(lines[0].removeprefix(_MARK), path)
    try:
        events = np.array(list(_events(lines[2:])), EVENT)
    except (ValueError, KeyError, OverflowError) as error:
        raise wrong(path, "events", ",".join(_COLUMNS), what_is_wrong(error)) from error
    return with_events(header, events.tobytes(), path)


def _events(lines: list[str]) -> Iterator[tuple[int, int, int, int, int, int]]:
    for row in csv.reader(lines):
        time_ns, kind, *_, slot, incarnation, number, value = row
        yield int(time_ns), int(number), int(value), int(slot), int(incarnation), _number(kind)


def _number(kind: str) -> int:
    return _NUMBERS[kind] if kind in _NUMBERS else int(kind)
