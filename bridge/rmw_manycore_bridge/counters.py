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
from typing import Any, NamedTuple

from rmw_manycore_py.native import _transport
from rmw_manycore_py.routes.route import Route

_MAGIC = b"MCBRIDG5"
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


class Left(NamedTuple):
    """What a previous process left of a route.

    :ivar forwarded: whether messages crossed, so that those published since then are lost.
    """

    numbers: LastNumbers
    forwarded: bool


NOTHING_LEFT = Left({}, False)


_INDEX = {name: index for index, name in enumerate(FIELDS)}
_LATENCY, _LATENCY_MAX, _STATE = _INDEX["latency_ns"], _INDEX["latency_max_ns"], _INDEX["state"]
_BUSY, _LOAD = _INDEX["busy_ns"], _INDEX["load_ppm"]
_WINDOW, _WINDOW_BUSY = _INDEX["window_ns"], _INDEX["window_busy_ns"]
_WINDOW_NS = 1_000_000_000
_MAX_LATENCY_NS = 3600 * 1_000_000_000
_GIDS = 4  # messages of earlier publishers may still be in flight
_GID_BYTES = 16
# Behind the rows: gid of a publisher, sequence number of its last message, and its row + 1.
_LAST = struct.Struct(f"{_GID_BYTES}sQQ")
_MIN_LAST, _MAX_LAST = 16, 4096
_REASON_BYTES = 248
_WORDS = len(FIELDS)
_ROW_BYTES = 8 * _WORDS + 8 + _GIDS * _GID_BYTES + _REASON_BYTES


def status_path(platform: str, stem: str, lane: int) -> Path:
    """Return the path of a bridge process's counter file; the stem has engine and direction."""
    return Path(_transport.platform_directory(platform)) / f"bridge-{stem}-{lane}"


def pattern_status_path(platform: str, stem: str, lane: int, index: int, slot: int) -> Path:
    """Return the path of the counter file of the index-th topic matched by a pattern."""
    path = status_path(platform, stem, lane)
    return path.with_name(f"{path.name}-{index}-{slot}")


def take_pattern_files(platform: str, stem: str, lane: int) -> dict[RouteKey, Left]:
    """Remove the pattern counter files of a previous process; return what it left, by route."""
    path = status_path(platform, stem, lane)
    found: dict[RouteKey, Left] = {}
    for file in path.parent.glob(f"{path.name}-*"):
        found |= _left(file)
        file.unlink(missing_ok=True)
    return found


class _LastTable:
    """Last numbers of all publishers, behind the rows in a file that grows with them.

    With no more room, the publisher that has been there longest gives way, as if it were new.
    """

    def __init__(self, file: Any, memory: mmap.mmap, start: int) -> None:
        self._file, self._memory, self._start = file, memory, start
        self._owners: list[tuple[Row, bytes]] = []  # by entry
        self._oldest = 0

    def entry(self, row: Row, publisher: bytes) -> int:
        """Return the place of a new entry."""
        index = len(self._owners)
        if self._has_room(index):
            self._owners.append((row, publisher))
        else:
            index = self._oldest
            self._oldest = (index + 1) % len(self._owners)
            owner, gone = self._owners[index]
            owner.forget(gone)
            self._owners[index] = row, publisher
        return self._start + index * _LAST.size

    def _has_room(self, index: int) -> bool:
        if self._start + (index + 1) * _LAST.size <= len(self._memory):
            return True
        if index >= _MAX_LAST:
            return False
        size = 2 * len(self._memory)
        try:
            os.posix_fallocate(self._file.fileno(), 0, size)
        except OSError:  # the file system is full
            return False
        self._memory = mmap.mmap(self._file.fileno(), size)
        return True

    def store(self, place: int, publisher: bytes, number: int, row: int) -> None:
        """Write an entry."""
        _LAST.pack_into(self._memory, place, publisher, number, row + 1)


class Row:
    """Counters of one route; only the process that owns them has a table of last numbers."""

    def __init__(self, memory: memoryview, table: _LastTable | None = None, index: int = 0) -> None:
        self._memory, self._table, self._index = memory, table, index
        self._words = memory[: 8 * _WORDS].cast("Q")
        self._gid_count = memory[8 * _WORDS : 8 * _WORDS + 8].cast("Q")
        self._places: dict[bytes, int] = {}  # in the table, by publisher gid
        self.last_passed: LastNumbers = {}  # by this process or a previous one
        self._left_off: LastNumbers = {}  # where a previous process was interrupted

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
        """Record a message before forwarding it, for a process that replaces this one.

        Count those that were lost while this process replaced another one.
        """
        if number <= self.last_passed.get(publisher, -1):  # latched, forwarded again
            return
        interrupted = self._left_off.pop(publisher, None)
        if interrupted is not None:
            self.add("lost", number - interrupted - 1)
        self._store_last(publisher, number)

    def _store_last(self, publisher: bytes, number: int) -> None:
        assert self._table is not None
        place = self._places.get(publisher)
        if place is None:
            place = self._places[publisher] = self._table.entry(self, publisher)
        self._table.store(place, publisher, number, self._index)
        self.last_passed[publisher] = number

    def forget(self, publisher: bytes) -> None:
        """Forget a publisher whose entry another one needs."""
        del self._places[publisher], self.last_passed[publisher]

    def inherit(self, left: Left) -> None:
        """Go on where a previous process ended."""
        for publisher, number in left.numbers.items():
            self._store_last(publisher, number)
        if left.forwarded:
            self._left_off.update(left.numbers)

    def rest(self) -> None:
        """Note that no messages are wanted: none that are missing before the next are lost."""
        self._left_off.clear()

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
        end = start + len(self.routes) * _ROW_BYTES
        self._last = view[end : len(view) - (len(view) - end) % _LAST.size]
        table = None if file is None else _LastTable(file, memory, end)
        self.rows = [
            Row(view[at : at + _ROW_BYTES], table, index)
            for index, at in enumerate(range(start, end, _ROW_BYTES))
        ]

    @classmethod
    def create(cls, path: Path, routes: Sequence[Route]) -> CounterFile:
        """Create a new file, replacing that of a dead process."""
        text = json.dumps([asdict(route) for route in routes]).encode()
        header = _MAGIC + os.getpid().to_bytes(8, "little") + len(text).to_bytes(8, "little")
        start = _rows_start(len(text))
        before = _left(path)
        fresh = path.with_name(f".{path.name}")
        file = fresh.open("wb+")
        fresh.chmod(0o600)
        fcntl.flock(file, fcntl.LOCK_EX)
        size = start + len(routes) * _ROW_BYTES + _MIN_LAST * _LAST.size
        file.write((header + text).ljust(size + -size % mmap.PAGESIZE, b"\0"))
        file.flush()
        fresh.rename(path)
        counters = cls(file, mmap.mmap(file.fileno(), 0))
        for route, row in zip(counters.routes, counters.rows, strict=True):
            row.inherit(before.get(key_of(route), NOTHING_LEFT))
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

    @property
    def last_numbers(self) -> list[LastNumbers]:
        """Sequence numbers forwarded last, by row and publisher."""
        found: list[LastNumbers] = [{} for _ in self.rows]
        for publisher, number, row in _LAST.iter_unpack(self._last):
            if 0 < row <= len(found):
                found[row - 1][publisher] = number
        return found

    def close(self) -> None:
        """Release the lock; the mapping is freed with the last row."""
        if self._file is not None:
            fcntl.flock(self._file, fcntl.LOCK_UN)  # the mapping has a descriptor of its own
            self._file.close()


def _left(path: Path) -> dict[RouteKey, Left]:
    """Return what a previous process left, by route."""
    found = CounterFile.open(path)
    if found is None:
        return {}
    rows = zip(found.routes, found.rows, found.last_numbers, strict=True)
    return {
        key_of(route): Left(numbers, row.as_dict()["state"] == "forwarding")
        for route, row, numbers in rows
    }


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
