# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""Chrome's trace event format, for chrome://tracing and ui.perfetto.dev; no dependencies."""

from __future__ import annotations

import json
from collections.abc import Iterator, Sequence
from pathlib import Path
from typing import Any, BinaryIO

import numpy as np
from numpy.typing import NDArray

from rmw_manycore_py.trace.counters import counters_of
from rmw_manycore_py.trace.events import Process, Trace
from rmw_manycore_py.trace.files.embedded import from_text, to_text, wrong
from rmw_manycore_py.trace.flows import flows_of
from rmw_manycore_py.trace.names import place_name, place_order, process_name
from rmw_manycore_py.trace.pairs import groups_of, split_by
from rmw_manycore_py.trace.slices import ARGUMENTS, Slices, category_of, name_of, slices_of

_KEY = "manycore"
_US = "%d.%03d"  # a time in microseconds from two integers
_SORT = ("what", "endpoint", "is_end_known")  # slices of one sort only differ in numbers


def write(trace: Trace, file: BinaryIO) -> None:
    """Write slices, flows and counters, plus the events for `read`."""
    file.write(f'{{"{_KEY}": {json.dumps(to_text(trace))},\n'.encode())
    file.write(b'"displayTimeUnit": "ns",\n"traceEvents": [\n')
    separator = ""
    for lines in _pieces(trace):
        if lines:
            file.write((separator + ",\n".join(lines)).encode())
            separator = ",\n"
    file.write(b"\n]}\n")


def read(content: bytes, path: Path) -> Trace:
    """Return the trace written by `write`."""
    try:
        data = json.loads(content)
    except ValueError as error:
        raise wrong(path, "", "a trace in JSON", f"{error} (the file is truncated?)") from error
    text = data.get(_KEY) if isinstance(data, dict) else None
    if not isinstance(text, str):
        raise wrong(path, _KEY, "a trace of manycore trace save", "a trace of another program")
    return from_text(text, path)


def _pieces(trace: Trace) -> Iterator[list[str]]:
    """Yield lines, in any order."""
    places: list[str] = []  # JSON of pid and tid per thread
    for pid, process in enumerate(trace.processes, 1):
        yield list(_process_lines(trace, pid, process))
        for thread in process.threads:
            places.append(f'"pid":{pid},"tid":{thread.tid}')
            name = f"{thread.name} ({thread.tid})"
            yield [_metadata("thread_name", pid, thread.tid, {"name": name})]
    for place, (_, thread) in zip(places, trace.threads(), strict=True):
        yield from _slices(trace, slices_of(thread), place)
    yield from _flows(flows_of(trace).flows, places)
    for counter in counters_of(trace):
        template = (
            f'{{"ph":"C","pid":0,"name":{_quoted(counter.name)},"ts":{_US},'
            '"args":{"value":%.12g}}'
        )
        yield filled(template, *in_us(counter.times_ns), counter.values)


def _process_lines(trace: Trace, pid: int, process: Process) -> Iterator[str]:
    name = f"{place_name(process)} > {process_name(trace, process)}"
    yield _metadata("process_name", pid, 0, {"name": name})
    yield _metadata("process_sort_index", pid, 0, {"sort_index": place_order(process)})


def _metadata(kind: str, pid: int, tid: int, arguments: dict[str, Any]) -> str:
    return json.dumps({"ph": "M", "name": kind, "pid": pid, "tid": tid, "args": arguments})


def filled(template: str, *columns: NDArray[Any]) -> list[str]:
    """Return the template filled with the values of each row."""
    rows = zip(*(column.tolist() for column in columns), strict=True)
    return list(map(template.__mod__, rows))


def in_us(times_ns: NDArray[Any]) -> tuple[NDArray[Any], NDArray[Any]]:
    """Return the two integers of `_US`."""
    return times_ns // 1000, times_ns % 1000


def _quoted(name: str) -> str:
    return json.dumps(name).replace("%", "%%")


def _slices(trace: Trace, slices: Slices, place: str) -> Iterator[list[str]]:
    """Yield the lines of slices that only differ in numbers."""
    sorts = groups_of(tuple(slices[key] for key in _SORT))
    for own in split_by(sorts):
        yield _slice_lines(trace, slices[own], place)


def _slice_lines(trace: Trace, slices: Slices, place: str) -> list[str]:
    one = slices[0]
    name = _quoted(name_of(trace, int(one["what"]), int(one["endpoint"])))
    columns = [*in_us(slices["begin_ns"])]
    kind = '"ph":"i","s":"t"'
    if not one["is_instant"]:
        kind = f'"ph":"X","dur":{_US}'
        columns[:0] = in_us(slices["end_ns"] - slices["begin_ns"])
    keys = ARGUMENTS.get(one["what"], ())
    columns += [slices[field] for _, field in keys]
    arguments = [f'"{key}":%d' for key, _ in keys]
    if not one["is_end_known"]:
        arguments.append('"end":"unknown"')
    return filled(
        f'{{{kind},"ts":{_US},"name":{name},"cat":"{category_of(int(one["what"]))}",{place},'
        f'"args":{{{",".join(arguments)}}}}}',
        *columns,
    )


def _flows(flows: NDArray[Any], places: Sequence[str]) -> Iterator[list[str]]:
    numbers = np.arange(1, len(flows) + 1)
    for phase, step in (("s", "write"), ("t", "receive"), ("f", "claim")):
        # Bind to the enclosing slice, not to the next one.
        bound = ',"bp":"e"' if phase == "f" else ""
        for thread, place in enumerate(places):
            own = flows[f"{step}_thread"] == thread
            yield filled(
                f'{{"ph":"{phase}","id":%d,"name":"message","cat":"message",{place},'
                f'"ts":{_US}{bound}}}',
                numbers[own],
                *in_us(flows[f"{step}_ns"][own]),
            )
