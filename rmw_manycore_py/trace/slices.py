# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""What a thread did when: its events as spans of time."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from types import MappingProxyType
from typing import Any, NamedTuple

from rmw_manycore_py.trace.events import (
    NO_ENDPOINT,
    Kind,
    RecordId,
    Thread,
    Trace,
    endpoint_id,
    endpoint_in,
)

Row = tuple[int, int, int, int, int, int]  # time, number, value, endpoint, incarnation, kind
_NOTHING: Mapping[str, Any] = MappingProxyType({})
_UNKNOWN: Mapping[str, Any] = MappingProxyType({"end": "unknown"})
_INSTANTS = {
    Kind.LOST: "lost",
    Kind.EXPIRED: "expired",
    Kind.BLOCKED: "blocked",
    Kind.MATCH: "match",
    Kind.JOIN: "process joined",
    Kind.LEAVE: "process left",
}


class Slice(NamedTuple):
    """A span of a thread's time; a tuple, as there are hundreds of thousands of them."""

    name: str
    category: str
    begin_ns: int
    end_ns: int  # where it is unknown, when the thread was last seen
    arguments: Mapping[str, Any] = _NOTHING
    record: RecordId | None = None  # of a publish, receive, take or callback
    is_instant: bool = False


def slices_of(trace: Trace, thread: Thread) -> list[Slice]:
    """Return the spans of a thread, in the order of their ends."""
    spans = _Spans(trace, bool((thread.events["kind"] == Kind.WAIT_BEGIN).any()))
    spans.follow(thread.events.tolist())
    return spans.slices


class _Spans:
    """Goes through the events of a thread once."""

    def __init__(self, trace: Trace, waits: bool) -> None:
        self.slices: list[Slice] = []
        self._trace = trace
        self._waits = waits  # a thread of a pool that never waits shows no end of its callbacks
        self._waiting: Row | None = None
        self._publishing: Row | None = None
        self._serializing: Row | None = None
        self._written: Row | None = None  # of the publish that is going on
        self._callback: tuple[Row, RecordId] | None = None  # since its take was over
        self._claims: dict[RecordId, Row] = {}
        self._received: Row | None = None
        self._last_ns = 0
        self._names: dict[tuple[str, int, int], str] = {}
        self._handlers: dict[int, Callable[[Row], None]] = {
            **dict.fromkeys(map(int, _INSTANTS), self._instant),
            Kind.PUBLISH_BEGIN: self._begin_publish,
            Kind.SERIALIZE_BEGIN: self._begin_serialize,
            Kind.WRITE: self._end_serialize,
            Kind.PUBLISH_END: self._end_publish,
            Kind.REFUSED: self._end_publish,
            Kind.RECEIVE: self._receive,
            Kind.WAIT_BEGIN: self._begin_wait,
            Kind.WAIT_END: self._end_wait,
            Kind.CLAIM: self._claim,
            Kind.RELEASE: self._release,
        }

    def follow(self, rows: list[Row]) -> None:
        """Take all events, then end what was going on when the trace ended."""
        find = self._handlers.get
        for row in rows:
            handler = find(row[5])
            if handler is not None:
                handler(row)
            self._last_ns = row[0]
        self._finish()

    def _finish(self) -> None:
        self._end_callback(self._last_ns, known=False)
        self._end_receive()
        for record, claim in self._claims.items():
            self._unfinished(self._name("take ", claim), "take", claim, record)
        begin = self._publishing or self._written
        if begin is not None:
            written = self._written and (self._endpoint(self._written), self._written[1])
            self._unfinished(self._name("publish ", begin), "publish", begin, written)
        if self._waiting is not None:
            self._unfinished("wait", "wait", self._waiting, None)

    def _unfinished(self, name: str, category: str, begin: Row, record: RecordId | None) -> None:
        self.slices.append(Slice(name, category, begin[0], self._last_ns, _UNKNOWN, record))

    @staticmethod
    def _endpoint(row: Row) -> int:
        return endpoint_id(row[3], row[4])

    def _name(self, what: str, row: Row) -> str:
        key = (what, row[3], row[4])
        name = self._names.get(key)
        if name is None:
            on = "" if row[3] == NO_ENDPOINT else self._trace.topic_of(self._endpoint(row))
            name = self._names[key] = f"{what}{on}".rstrip()
        return name

    def _instant(self, row: Row) -> None:
        name = self._name(f"{_INSTANTS[Kind(row[5])]} ", row)
        arguments = {"count": row[2]} if row[5] == Kind.LOST else _NOTHING
        self.slices.append(Slice(name, "event", row[0], row[0], arguments, None, True))

    def _begin_publish(self, row: Row) -> None:
        self._publishing = row

    def _begin_serialize(self, row: Row) -> None:
        self._serializing = row

    def _end_serialize(self, row: Row) -> None:
        self._written = row
        begin, self._serializing = self._serializing, None
        if begin is not None:
            self.slices.append(Slice("serialize", "serialize", begin[0], row[0]))

    def _end_publish(self, row: Row) -> None:
        # Without a begin, the trace was switched on in between.
        begin = self._publishing or self._written
        self._publishing = self._written = None
        if begin is None:
            return
        if row[5] == Kind.REFUSED:
            name, record = self._name("refused publish ", row), None
        else:
            name, record = self._name("publish ", row), (self._endpoint(row), row[1])
        arguments = {"bytes": begin[2], "number": row[1]}
        self.slices.append(Slice(name, "publish", begin[0], row[0], arguments, record))

    def _begin_wait(self, row: Row) -> None:
        self._end_callback(row[0])
        self._waiting = row

    def _end_wait(self, row: Row) -> None:
        begin, self._waiting = self._waiting, None
        if begin is not None:
            self.slices.append(Slice("wait", "wait", begin[0], row[0]))

    def _claim(self, row: Row) -> None:
        self._end_callback(row[0])
        self._claims[endpoint_in(row[2]), row[1]] = row

    def _release(self, row: Row) -> None:
        record = (endpoint_in(row[2]), row[1])
        claim = self._claims.pop(record, None)
        if claim is not None:
            name = self._name("take ", row)
            arguments = {"number": row[1]}
            self.slices.append(Slice(name, "take", claim[0], row[0], arguments, record))
        self._callback = (row, record)

    def _end_callback(self, time_ns: int, known: bool = True) -> None:
        if self._callback is None:
            return
        (begin, record), self._callback = self._callback, None
        known = known and self._waits
        end_ns = time_ns if known else max(self._last_ns, begin[0])
        arguments = _NOTHING if known else _UNKNOWN
        name = self._name("callback ", begin)
        self.slices.append(Slice(name, "callback", begin[0], end_ns, arguments, record))

    def _receive(self, row: Row) -> None:
        self._end_receive()
        self._received = row

    def _end_receive(self) -> None:
        if self._received is not None:
            row, self._received = self._received, None
            record = (self._endpoint(row), row[1])
            end_ns = max(self._last_ns, row[0])
            arguments = {"number": row[1]}
            name = self._name("receive ", row)
            self.slices.append(Slice(name, "receive", row[0], end_ns, arguments, record))
