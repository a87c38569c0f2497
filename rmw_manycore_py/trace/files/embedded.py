# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""A trace as text embedded in viewer files, from which `latency` and `compare` read it."""

from __future__ import annotations

import base64
import binascii
import json
import zlib
from pathlib import Path
from typing import Annotated, Any, Literal

import numpy as np
from pydantic import BaseModel, ConfigDict, Field, NonNegativeInt, ValidationError

from rmw_manycore_py.errors import FileError, Problem, invalid_field, what_is_wrong
from rmw_manycore_py.trace.events import EVENT, Endpoint, Process, Thread, Trace

VERSION = 1
_QUICKLY = 1  # zlib level; takes a tenth of the default's time
_Cluster = Annotated[int, Field(ge=0, le=64)]  # as many as a platform may have; 0: none


class _Strict(BaseModel):
    model_config = ConfigDict(extra="forbid", strict=True)


class _Thread(_Strict):
    tid: int
    name: str
    events: NonNegativeInt
    lost: NonNegativeInt


class _Process(_Strict):
    pid: int
    cluster: _Cluster
    core: int | None
    host_cpu: int | None
    label: str
    is_receive_thread: bool
    is_alive: bool
    threads: list[_Thread]
    unplaced: NonNegativeInt


class _Endpoint(_Strict):
    id: int = Field(ge=0, lt=1 << 48)
    is_publisher: bool
    role: Literal["topic", "request", "reply"]
    topic: str
    type: str
    node: str
    cluster: _Cluster


class _Version(BaseModel):
    """What a header of any version has."""

    version: int


class _Header(_Strict):
    version: int
    platform: str
    unplaced: NonNegativeInt
    processes: list[_Process]
    endpoints: list[_Endpoint]


def header_of(trace: Trace) -> dict[str, Any]:
    """Return everything except the events."""
    processes = [
        {**_fields(p), "threads": [{**_fields(t), "events": len(t.events)} for t in p.threads]}
        for p in trace.processes
    ]
    endpoints = [{"id": key, **_fields(endpoint)} for key, endpoint in trace.endpoints.items()]
    return {
        "version": VERSION,
        "platform": trace.platform,
        "unplaced": trace.unplaced,
        "processes": processes,
        "endpoints": endpoints,
    }


def _fields(row: object) -> dict[str, Any]:
    return dict(vars(row))


def to_text(trace: Trace) -> str:
    """Return header and events: one line of JSON, one line of base64."""
    parts = [thread.events for _, thread in trace.threads()]
    events = np.concatenate(parts).tobytes() if parts else b""
    packed = base64.b64encode(zlib.compress(events, _QUICKLY)).decode()
    return f"{json.dumps(header_of(trace))}\n{packed}"


def from_text(text: str, path: Path) -> Trace:
    """Parse the output of `to_text`."""
    first, _, second = text.partition("\n")
    header = parsed_header(first, path)
    try:
        data = zlib.decompress(base64.b64decode(second, validate=True))
    except (binascii.Error, zlib.error, ValueError) as error:
        raise wrong(path, "events", "compressed events", what_is_wrong(error)) from error
    return with_events(header, data, path)


def parsed_header(text: str, path: Path) -> _Header:
    """Return the validated header."""
    try:
        version = _Version.model_validate_json(text).version
        if version != VERSION:
            found = f"{version} (of another version of manycore: use that one)"
            raise wrong(path, "version", str(VERSION), found)
        return _Header.model_validate_json(text)
    except ValidationError as error:
        key, found = invalid_field(error)
        raise wrong(path, key or "header", "what manycore trace save writes", found) from error


def with_events(header: _Header, data: bytes, path: Path) -> Trace:
    """Return the trace of a header and the concatenated events of all threads."""
    count = sum(thread.events for process in header.processes for thread in process.threads)
    if len(data) != count * EVENT.itemsize:
        found = f"{len(data) // EVENT.itemsize} (the file is truncated?)"
        raise wrong(path, "events", f"{count} events", found)
    events = np.frombuffer(data, EVENT)
    position = 0
    processes = []
    for process in header.processes:
        threads = []
        for thread in process.threads:
            own = events[position : position + thread.events]
            threads.append(Thread(thread.tid, thread.name, own, thread.lost))
            position += thread.events
        fields = process.model_dump(exclude={"threads"})
        processes.append(Process(threads=tuple(threads), **fields))
    endpoints = {e.id: Endpoint(**e.model_dump(exclude={"id"})) for e in header.endpoints}
    return Trace(header.platform, tuple(processes), endpoints, header.unplaced)


def wrong(path: Path, key: str, expected: str, found: str) -> FileError:
    """Return the error for a file that is no trace, or an incomplete one."""
    return FileError(Problem(path, 0, key, expected, found))
