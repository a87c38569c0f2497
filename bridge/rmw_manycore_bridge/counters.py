# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""Counters of each route, in files that `manycore bridge status` reads without IPC.

Each bridge process has one file in the platform's directory, which is removed with the platform.
Only that process writes to it; it holds a lock on the file during its lifetime.
"""

from __future__ import annotations

import fcntl
import json
import mmap
import os
import struct
import time
from collections.abc import Mapping, Sequence
from dataclasses import asdict
from pathlib import Path
from typing import Any

from rmw_manycore_py.native import _transport
from rmw_manycore_py.routes.route import Route

_MAGIC = b"MCBRIDG4"
_HEADER_BYTES = 24  # magic, process id, bytes of the routes' JSON
# All fields have 64 bits. `latency_ns` is the sum over all messages of the time from source
# timestamp to forwarding. `busy_ns` is CPU time spent on the topic, `load_ppm` its CPU usage in
# the last full window; the current one began at `window_ns` (CLOCK_MONOTONIC) with
# `window_busy_ns`.
FIELDS = (
    "messages",
    "bytes",
    "lost",
    "too_fast",
    "too_large",
    "refused",
    "own",
    "timed_out",
    "unanswered",
    "repeated",
    "latency_ns",
    "latency_max_ns",
    "state",
    "latched",
    "busy_ns",
    "load_ppm",
    "window_ns",
    "window_busy_ns",
)
DROPS = ("lost", "too_fast", "too_large", "refused", "timed_out", "unanswered", "repeated")
STATES = ("waiting", "ready", "forwarding", "failed")
RouteKey = tuple[str, str, str, int]
LastNumbers = dict[bytes, int]  # last sequence number by publisher gid
_INDEX = {name: index for index, name in enumerate(FIELDS)}
_LATENCY, _LATENCY_MAX, _STATE = _INDEX["latency_ns"], _INDEX["latency_max_ns"], _INDEX["state"]
_BUSY, _LOAD = _INDEX["busy_ns"], _INDEX["load_ppm"]
_WINDOW, _WINDOW_BUSY = _INDEX["window_ns"], _INDEX["window_busy_ns"]
_WINDOW_NS = 1_000_000_000
_MAX_LATENCY_NS = 3600 * 1_000_000_000
_GIDS = 4  # messages of earlier publishers may still be in flight
_GID_BYTES = 16
# Publishers forwarded last, each with the sequence number of its last message.
_SOURCES = 16
_SOURCE = struct.Struct(f"{_GID_BYTES}sQ")
_REASON_BYTES = 248
_WORDS = len(FIELDS)
_SOURCES_AT = 8 * _WORDS + 8 + _GIDS * _GID_BYTES
_ROW_BYTES = _SOURCES_AT + _SOURCES * _SOURCE.size + _REASON_BYTES


def status_path(platform: str, stem: str, lane: int) -> Path:
    """Return the path of a bridge process's counter file; the stem has engine and direction."""
    return Path(_transport.platform_directory(platform)) / f"bridge-{stem}-{lane}"


def pattern_status_path(platform: str, stem: str, lane: int, index: int, slot: int) -> Path:
    """Return the path of the counter file of the index-th topic matched by a pattern."""
    path = status_path(platform, stem, lane)
    return path.with_name(f"{path.name}-{index}-{slot}")


def take_pattern_files(platform: str, stem: str, lane: int) -> dict[RouteKey, LastNumbers]:
    """Remove the pattern counter files of a previous process.

    Return the last sequence numbers it forwarded, by route.
    """
    path = status_path(platform, stem, lane)
    found: dict[RouteKey, LastNumbers] = {}
    for file in path.parent.glob(f"{path.name}-*"):
        found |= _last_numbers(file)
        file.unlink(missing_ok=True)
    return found


class Row:
    """Counters of one route."""

    def __init__(self, memory: memoryview) -> None:
        self._memory = memory
        self._words = memory[: 8 * _WORDS].cast("Q")
        self._gid_count = memory[8 * _WORDS : 8 * _WORDS + 8].cast("Q")
        self._offsets: dict[bytes, int] = {}  # in the memory, by publisher gid
        self.last_passed: LastNumbers = {}  # by this process or a previous one

    def passed(self, size: int, latency_ns: int) -> None:
        """Count a forwarded message of `size` bytes."""
        words = self._words
        words[0] += 1
        words[1] += size
        if 0 < latency_ns < _MAX_LATENCY_NS:  # otherwise the clocks of two hosts disagree
            words[_LATENCY] += latency_ns
            if latency_ns > words[_LATENCY_MAX]:
                words[_LATENCY_MAX] = latency_ns

    def add(self, field: str, count: int = 1) -> int:
        """Increment another counter; return its new value."""
        self._words[_INDEX[field]] += count
        return self._words[_INDEX[field]]

    def worked(self, cpu_ns: int) -> None:
        """Add CPU time spent on the topic."""
        words, now_ns = self._words, time.monotonic_ns()
        words[_BUSY] += cpu_ns
        window_ns = now_ns - words[_WINDOW]
        if window_ns >= _WINDOW_NS:
            words[_LOAD] = (words[_BUSY] - words[_WINDOW_BUSY]) * 1_000_000 // window_ns
            words[_WINDOW], words[_WINDOW_BUSY] = now_ns, words[_BUSY]

    @property
    def load(self) -> float:
        """CPU usage of the topic in the last window, 0..1; 0 if messages have stopped."""
        words = self._words
        is_recent = time.monotonic_ns() - words[_WINDOW] < 3 * _WINDOW_NS
        return words[_LOAD] / 1e6 if is_recent else 0.0

    def set_latched(self, latched: bool) -> None:
        """Set whether the topic is latched (transient local); latched topics do not move."""
        self._words[_INDEX["latched"]] = latched

    @property
    def is_latched(self) -> bool:
        """Whether the topic is latched."""
        return bool(self._words[_INDEX["latched"]])

    def set_state(self, state: str, reason: str = "") -> None:
        """Set the state of the route, and why it does not work."""
        text = reason.encode()[: _REASON_BYTES - 1]
        self._memory[-_REASON_BYTES:] = text.ljust(_REASON_BYTES, b"\0")
        self._words[_STATE] = STATES.index(state)

    def add_gid(self, gid: bytes) -> None:
        """Register a publisher of this bridge before it publishes."""
        start = 8 * _WORDS + 8 + self._gid_count[0] % _GIDS * _GID_BYTES
        self._memory[start : start + _GID_BYTES] = gid
        self._gid_count[0] += 1

    def has_gid(self, gid: bytes) -> bool:
        """Return whether a publisher belongs to this bridge."""
        start = 8 * _WORDS + 8
        gids = bytes(self._memory[start : start + _GIDS * _GID_BYTES])
        return any(gids[i : i + _GID_BYTES] == gid for i in range(0, len(gids), _GID_BYTES))

    def note_last(self, publisher: bytes, number: int) -> None:
        """Record a message before forwarding it, for a process that replaces this one."""
        if number <= self.last_passed.get(publisher, -1):  # latched, forwarded again
            return
        offset = self._offsets.get(publisher)
        if offset is None:
            offset = self._offsets[publisher] = (
                _SOURCES_AT + len(self._offsets) % _SOURCES * _SOURCE.size
            )
        _SOURCE.pack_into(self._memory, offset, publisher, number)
        self.last_passed[publisher] = number

    def inherit(self, numbers: LastNumbers) -> None:
        """Take over the sequence numbers that a previous process forwarded last."""
        for publisher, number in numbers.items():
            self.note_last(publisher, number)

    @property
    def last_numbers(self) -> LastNumbers:
        """Sequence numbers forwarded last, by publisher."""
        entries = _SOURCE.iter_unpack(self._memory[_SOURCES_AT:-_REASON_BYTES])
        return {publisher: number for publisher, number in entries if any(publisher)}

    def as_dict(self) -> dict[str, Any]:
        """Return all fields by name."""
        row: dict[str, Any] = dict(zip(FIELDS, self._words, strict=True))
        row["state"] = STATES[row["state"]]
        row["reason"] = bytes(self._memory[-_REASON_BYTES:]).rstrip(b"\0").decode(errors="ignore")
        return row


class CounterFile:
    """Counter rows of one bridge process."""

    def __init__(self, file: Any, memory: mmap.mmap) -> None:
        self._file = file  # holds the lock
        view = memoryview(memory)
        self.pid = int.from_bytes(view[8:16], "little")
        text_bytes = int.from_bytes(view[16:24], "little")
        self.routes = json.loads(bytes(view[_HEADER_BYTES : _HEADER_BYTES + text_bytes]))
        start = _rows_start(text_bytes)
        self.rows = [
            Row(view[at : at + _ROW_BYTES])
            for at in range(start, start + len(self.routes) * _ROW_BYTES, _ROW_BYTES)
        ]

    @classmethod
    def create(cls, path: Path, routes: Sequence[Route]) -> CounterFile:
        """Create a new file, replacing that of a dead process."""
        text = json.dumps([asdict(route) for route in routes]).encode()
        header = _MAGIC + os.getpid().to_bytes(8, "little") + len(text).to_bytes(8, "little")
        start = _rows_start(len(text))
        before = _last_numbers(path)
        fresh = path.with_name(f".{path.name}")
        file = fresh.open("wb+")
        fresh.chmod(0o600)
        fcntl.flock(file, fcntl.LOCK_EX)
        file.write((header + text).ljust(start + len(routes) * _ROW_BYTES, b"\0"))
        file.flush()
        fresh.rename(path)
        counters = cls(file, mmap.mmap(file.fileno(), 0))
        for route, row in zip(counters.routes, counters.rows, strict=True):
            row.inherit(before.get(key_of(route), {}))
        return counters

    @classmethod
    def open(cls, path: Path) -> CounterFile | None:
        """Open another process's file; None if it is missing or unreadable."""
        try:
            with path.open("rb") as file:
                memory = mmap.mmap(file.fileno(), 0, access=mmap.ACCESS_READ)
        except (OSError, ValueError):
            return None
        return cls(None, memory) if memory[:8] == _MAGIC else None

    def close(self) -> None:
        """Release the lock; the mapping is freed with the last row."""
        if self._file is not None:
            self._file.close()


def _last_numbers(path: Path) -> dict[RouteKey, LastNumbers]:
    """Return what a previous process forwarded last, by route."""
    found = CounterFile.open(path)
    if found is None:
        return {}
    rows = zip(found.routes, found.rows, strict=True)
    return {key_of(route): row.last_numbers for route, row in rows}


def key_of(route: Mapping[str, Any]) -> RouteKey:
    """Return the key that identifies a route within a process, from its fields."""
    return (route["kind"], route["inside"], route["outside"], route["domain"])


def _rows_start(text_bytes: int) -> int:
    return (_HEADER_BYTES + text_bytes + 7) // 8 * 8


def is_locked(path: Path) -> bool:
    """Return whether the process that owns a counter file is alive."""
    try:
        with path.open("rb") as file:
            fcntl.flock(file, fcntl.LOCK_SH | fcntl.LOCK_NB)
    except BlockingIOError:
        return True
    except OSError:
        return False
    return False
