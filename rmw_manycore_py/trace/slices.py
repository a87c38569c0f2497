# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""What a thread did when: its events as spans of time."""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import Any

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
_INSTANTS = {
    Kind.LOST: "lost",
    Kind.EXPIRED: "expired",
    Kind.BLOCKED: "blocked",
    Kind.MATCH: "match",
    Kind.JOIN: "process joined",
    Kind.LEAVE: "process left",
}
_SPANS = {Kind.HOP_BEGIN: "bridge hop", Kind.PASS_BEGIN: "NDT pass", Kind.WAIT_BEGIN: "wait"}
_ENDS = {
    Kind.HOP_END: Kind.HOP_BEGIN,
    Kind.PASS_END: Kind.PASS_BEGIN,
    Kind.WAIT_END: Kind.WAIT_BEGIN,
}


@dataclass(frozen=True)
class Slice:
    """A span of a thread's time; without an end it lasts for an unknown time, or for none."""

    name: str
    category: str
    begin_ns: int
    end_ns: int
    arguments: dict[str, Any] = field(default_factory=dict)
    record: RecordId | None = None  # of a publish, receive or take
    is_instant: bool = False


def slices_of(trace: Trace, thread: Thread) -> list[Slice]:
    """Return the spans of a thread, in the order of their ends."""
    spans = _Spans(trace, bool((thread.events["kind"] == Kind.WAIT_BEGIN).any()))
    for row in thread.events.tolist():
        spans.add(row)
    spans.finish()
    return spans.slices


class _Spans:
    """Goes through the events of a thread once."""

    def __init__(self, trace: Trace, waits: bool) -> None:
        self.slices: list[Slice] = []
        self._trace = trace
        self._waits = waits  # a thread of a pool that never waits shows no end of its callbacks
        self._open: dict[Kind, Row] = {}
        self._callback: tuple[Row, RecordId] | None = None  # since its take was over
        self._claims: dict[RecordId, Row] = {}
        self._received: Row | None = None
        self._written: Row | None = None  # of the publish that is going on
        self._last_ns = 0

    def add(self, row: Row) -> None:
        time_ns, kind = row[0], row[5]
        if kind in (Kind.CLAIM, Kind.WAIT_BEGIN):
            self._end_callback(time_ns)
        if kind == Kind.RECEIVE:
            self._end_receive()
            self._received = row
        elif kind in _INSTANTS:
            self._instant(row)
        elif kind == Kind.CLAIM:
            self._claims[endpoint_in(row[2]), row[1]] = row
        elif kind == Kind.RELEASE:
            self._end_take(row)
        elif kind in (Kind.PUBLISH_END, Kind.REFUSED):
            self._end_publish(row)
        elif kind == Kind.WRITE:
            self._end_serialize(row)
        elif kind in _ENDS:
            self._end_span(row, _ENDS[Kind(kind)])
        elif kind in (Kind.PUBLISH_BEGIN, Kind.SERIALIZE_BEGIN) or kind in _SPANS:
            self._open[Kind(kind)] = row
        self._last_ns = time_ns

    def finish(self) -> None:
        """End what was going on when the trace ended."""
        self._end_callback(self._last_ns, known=False)
        self._end_receive()
        for record, claim in self._claims.items():
            self._unfinished(f"take {self._topic(claim)}", "take", claim, record)
        begin = self._open.pop(Kind.PUBLISH_BEGIN, self._written)
        if begin is not None:
            written = self._written and (self._endpoint(self._written), self._written[1])
            self._unfinished(f"publish {self._topic(begin)}", "publish", begin, written)
        if wait := self._open.pop(Kind.WAIT_BEGIN, None):
            self._unfinished("wait", "wait", wait, None)

    def _unfinished(self, name: str, category: str, begin: Row, record: RecordId | None) -> None:
        unknown = {"end": "unknown"}
        self.slices.append(Slice(name, category, begin[0], self._last_ns, unknown, record))

    def _endpoint(self, row: Row) -> int:
        return endpoint_id(row[3], row[4])

    def _topic(self, row: Row) -> str:
        return self._trace.topic_of(self._endpoint(row))

    def _instant(self, row: Row) -> None:
        name = _INSTANTS[Kind(row[5])]
        on = "" if row[3] == NO_ENDPOINT else f" {self._topic(row)}"
        arguments = {"count": row[2]} if row[5] == Kind.LOST else {}
        self.slices.append(
            Slice(f"{name}{on}", "event", row[0], row[0], arguments, is_instant=True)
        )

    def _end_callback(self, time_ns: int, known: bool = True) -> None:
        if self._callback is None:
            return
        (begin, record), self._callback = self._callback, None
        known = known and self._waits
        end_ns = time_ns if known else max(self._last_ns, begin[0])
        arguments = {} if known else {"end": "unknown"}
        name = f"callback {self._topic(begin)}"
        self.slices.append(Slice(name, "callback", begin[0], end_ns, arguments, record))

    def _end_receive(self) -> None:
        if self._received is not None:
            row, self._received = self._received, None
            record = (self._endpoint(row), row[1])
            name = f"receive {self._topic(row)}"
            end_ns = max(self._last_ns, row[0])
            self.slices.append(Slice(name, "receive", row[0], end_ns, {"number": row[1]}, record))

    def _end_take(self, row: Row) -> None:
        record = (endpoint_in(row[2]), row[1])
        claim = self._claims.pop(record, None)
        if claim is not None:
            name = f"take {self._topic(row)}"
            self.slices.append(Slice(name, "take", claim[0], row[0], {"number": row[1]}, record))
        self._callback = (row, record)

    def _end_publish(self, row: Row) -> None:
        # Without a begin, the trace was switched on in between.
        begin = self._open.pop(Kind.PUBLISH_BEGIN, self._written)
        self._written = None
        if begin is None:
            return
        refused = row[5] == Kind.REFUSED
        record = None if refused else (self._endpoint(row), row[1])
        name = f"{'refused ' if refused else ''}publish {self._topic(row)}"
        arguments = {"bytes": begin[2]} if refused else {"bytes": begin[2], "number": row[1]}
        self.slices.append(Slice(name, "publish", begin[0], row[0], arguments, record))

    def _end_serialize(self, row: Row) -> None:
        self._written = row
        begin = self._open.pop(Kind.SERIALIZE_BEGIN, None)
        if begin is not None:
            self.slices.append(Slice("serialize", "serialize", begin[0], row[0], {"bytes": row[2]}))

    def _end_span(self, row: Row, kind: Kind) -> None:
        begin = self._open.pop(kind, None)
        if begin is not None:
            self.slices.append(Slice(_SPANS[kind], _SPANS[kind].lower(), begin[0], row[0]))
