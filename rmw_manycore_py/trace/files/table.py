# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""The events themselves, one a line, with names: for spreadsheets and programs."""

from __future__ import annotations

import csv
import io
import json
from collections.abc import Iterator
from pathlib import Path
from typing import BinaryIO

import numpy as np

from rmw_manycore_py.errors import what_is_wrong
from rmw_manycore_py.trace.events import EVENT, NO_ENDPOINT, Kind, Trace, endpoint_id
from rmw_manycore_py.trace.files.embedded import header_of, parsed_header, with_events, wrong

_MARK = "# manycore trace "
_COLUMNS = (
    *("time_ns", "kind", "cluster", "core", "pid", "tid", "node", "topic"),
    *("endpoint", "incarnation", "number", "value"),
)
_NAMES = {kind.value: kind.name.lower() for kind in Kind}
_NUMBERS = {name: number for number, name in _NAMES.items()}


def write(trace: Trace, file: BinaryIO) -> None:
    """Write a comment with the header, the columns' names, and the events, thread after thread."""
    text = io.TextIOWrapper(file, encoding="utf-8", newline="")
    text.write(f"{_MARK}{json.dumps(header_of(trace))}\n{','.join(_COLUMNS)}\n")
    for process, thread in trace.threads():
        core = "" if process.core is None else str(process.core)
        place = f"{process.cluster},{core},{process.pid},{thread.tid}"
        names: dict[tuple[int, int], str] = {}
        for time_ns, number, value, slot, incarnation, kind in thread.events.tolist():
            name = names.get((slot, incarnation))
            if name is None:
                name = names[slot, incarnation] = _names_of(trace, slot, incarnation)
            kind_name = _NAMES.get(kind, kind)
            text.write(
                f"{time_ns},{kind_name},{place},{name},{slot},{incarnation},{number},{value}\n"
            )
    text.flush()
    text.detach()


def _names_of(trace: Trace, slot: int, incarnation: int) -> str:
    if slot == NO_ENDPOINT:
        return ","
    endpoint = endpoint_id(slot, incarnation)
    return f"{trace.node_of(endpoint)},{trace.topic_of(endpoint)}"


def read(content: bytes, path: Path) -> Trace:
    """Return the trace that `write` put into a file."""
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
