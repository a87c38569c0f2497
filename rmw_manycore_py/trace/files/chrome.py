# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""Chrome's trace event format: for chrome://tracing and ui.perfetto.dev, without a dependency."""

from __future__ import annotations

import json
from collections.abc import Iterator
from pathlib import Path
from typing import Any, BinaryIO

from rmw_manycore_py.trace.events import Process, Trace
from rmw_manycore_py.trace.files.embedded import from_text, to_text, wrong
from rmw_manycore_py.trace.files.tracks import core_name, counters_of, process_name
from rmw_manycore_py.trace.flows import Flow, flows_of
from rmw_manycore_py.trace.slices import Slice, slices_of

_KEY = "manycore"
_PIECE = 2000  # lines written at a time
_CORES = 1000  # more than a cluster has


def write(trace: Trace, file: BinaryIO) -> None:
    """Write slices, flows and counters, and the events themselves for `read`."""
    file.write(f'{{"{_KEY}": {json.dumps(to_text(trace))},\n'.encode())
    file.write(b'"displayTimeUnit": "ns",\n"traceEvents": [\n')
    piece: list[str] = []
    separator = ""
    for line in _lines(trace):
        piece.append(line)
        if len(piece) == _PIECE:
            file.write((separator + ",\n".join(piece)).encode())
            separator = ",\n"
            piece.clear()
    if piece:
        file.write((separator + ",\n".join(piece)).encode())
    file.write(b"\n]}\n")


def read(content: bytes, path: Path) -> Trace:
    """Return the trace that `write` put into a file."""
    try:
        data = json.loads(content)
    except ValueError as error:
        raise wrong(path, "", "a trace in JSON", f"{error} (the file is truncated?)") from error
    text = data.get(_KEY) if isinstance(data, dict) else None
    if not isinstance(text, str):
        raise wrong(path, _KEY, "a trace of manycore trace save", "a trace of another program")
    return from_text(text, path)


def _lines(trace: Trace) -> Iterator[str]:
    ids: list[tuple[int, int]] = []  # of each thread: pid and tid for the viewer
    for pid, process in enumerate(trace.processes, 1):
        yield from _process_lines(trace, pid, process)
        for thread in process.threads:
            ids.append((pid, thread.tid))
            name = f"{thread.name} ({thread.tid})"
            yield _metadata("thread_name", pid, thread.tid, {"name": name})
    names = _Texts()
    for (pid, tid), (_, thread) in zip(ids, trace.threads(), strict=True):
        place = f'"pid":{pid},"tid":{tid}'
        for one in slices_of(trace, thread):
            yield _slice_line(one, place, names)
    for number, flow in enumerate(flows_of(trace).flows, 1):
        yield from _flow_lines(number, flow, ids)
    for counter in counters_of(trace):
        text = names.of(counter.name)
        for time_ns, value in counter.samples:
            yield (
                f'{{"ph":"C","pid":0,"name":{text},"ts":{time_ns / 1000:.3f},'
                f'"args":{{"value":{value:g}}}}}'
            )


def _process_lines(trace: Trace, pid: int, process: Process) -> Iterator[str]:
    place = f"cluster {process.cluster} > {core_name(process)}"
    name = f"{place} > {process_name(trace, process)}"
    yield _metadata("process_name", pid, 0, {"name": name})
    core = -1 if process.core is None else process.core
    order = process.cluster * _CORES + (0 if process.is_receive_thread else core + 2)
    yield _metadata("process_sort_index", pid, 0, {"sort_index": order})


def _metadata(kind: str, pid: int, tid: int, arguments: dict[str, Any]) -> str:
    return json.dumps({"ph": "M", "name": kind, "pid": pid, "tid": tid, "args": arguments})


class _Texts:
    """Names as JSON, each made once."""

    def __init__(self) -> None:
        self._known: dict[str, str] = {}

    def of(self, name: str) -> str:
        text = self._known.get(name)
        if text is None:
            text = self._known[name] = json.dumps(name)
        return text


def _slice_line(one: Slice, place: str, names: _Texts) -> str:
    name, category, begin_ns, end_ns, values, _, is_instant = one
    # Numbers, and words of ours that need no escape.
    arguments = ",".join(
        [f'"{k}":{v}' if type(v) is int else f'"{k}":"{v}"' for k, v in values.items()]
    )
    kind = '"i","s":"t"' if is_instant else f'"X","dur":{(end_ns - begin_ns) / 1000:.3f}'
    return (
        f'{{"ph":{kind},"name":{names.of(name)},"cat":"{category}",{place},'
        f'"ts":{begin_ns / 1000:.3f},"args":{{{arguments}}}}}'
    )


def _flow_lines(number: int, flow: Flow, ids: list[tuple[int, int]]) -> Iterator[str]:
    places = (("s", flow.write), ("t", flow.receive), ("f", flow.claim))
    for phase, place in places:
        if place is not None:
            pid, tid = ids[place.thread]
            # To the slice around this moment, not to the next one.
            bound = ',"bp":"e"' if phase == "f" else ""
            yield (
                f'{{"ph":"{phase}","id":{number},"name":"message","cat":"message",'
                f'"pid":{pid},"tid":{tid},"ts":{place.time_ns / 1000:.3f}{bound}}}'
            )
