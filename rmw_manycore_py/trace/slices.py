# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""Events of threads as time spans, column by column."""

from __future__ import annotations

from collections.abc import Sequence
from enum import IntEnum
from typing import Any

import numpy as np
from numpy.typing import NDArray

from rmw_manycore_py.trace.events import (
    NO_ID,
    EndpointId,
    Events,
    Kind,
    Thread,
    Trace,
    endpoint_ids,
    endpoint_in,
)
from rmw_manycore_py.trace.pairs import Indices, by_key, in_turns, next_of

Slices = NDArray[Any]  # of SLICE


class What(IntEnum):
    """What a span represents."""

    WAIT = 0
    SERIALIZE = 1
    PUBLISH = 2
    REFUSED = 3
    TAKE = 4
    CALLBACK = 5
    RECEIVE = 6
    LOST = 7
    EXPIRED = 8
    BLOCKED = 9
    MATCH = 10
    JOIN = 11
    LEAVE = 12
    BRIDGE_OUT = 13
    BRIDGE_IN = 14
    ALIGN = 15
    PASS = 16
    HAND = 17
    ARRIVE = 18
    DROP = 19
    IN_PLACE = 20
    SUPERSEDED = 21


# Category shown by viewers, and prefix of the name; the topic follows.
_WORDS = {
    What.WAIT: ("wait", "wait"),
    What.SERIALIZE: ("serialize", "serialize"),
    What.PUBLISH: ("publish", "publish"),
    What.REFUSED: ("publish", "refused publish"),
    What.TAKE: ("take", "take"),
    What.CALLBACK: ("callback", "callback"),
    What.RECEIVE: ("receive", "receive"),
    What.LOST: ("event", "lost"),
    What.SUPERSEDED: ("event", "superseded"),
    What.EXPIRED: ("event", "expired"),
    What.BLOCKED: ("event", "blocked"),
    What.MATCH: ("event", "match"),
    What.JOIN: ("event", "process joined"),
    What.LEAVE: ("event", "process left"),
    What.BRIDGE_OUT: ("bridge", "bridge out"),
    What.BRIDGE_IN: ("bridge", "bridge in"),
    What.ALIGN: ("ndt", "NDT alignment"),
    What.PASS: ("ndt", "NDT pass"),
    What.HAND: ("transfer", "hand over"),
    What.ARRIVE: ("transfer", "arrive"),
    What.DROP: ("transfer", "drop"),
    What.IN_PLACE: ("event", "in place"),
}
# Arguments shown by viewers: label, and field of SLICE.
ARGUMENTS = {
    What.PUBLISH: (("bytes", "value"), ("number", "number")),
    What.REFUSED: (("bytes", "value"),),
    What.TAKE: (("number", "number"),),
    What.RECEIVE: (("number", "number"),),
    What.LOST: (("count", "value"),),
    What.SUPERSEDED: (("count", "value"),),
    What.BRIDGE_OUT: (("number", "number"),),
    What.BRIDGE_IN: (("age_ns", "value"), ("number", "number")),
    What.PASS: (("pass", "number"),),
    What.HAND: (("number", "number"), ("cluster", "value")),
    What.ARRIVE: (("number", "number"), ("cluster", "value")),
    What.DROP: (("number", "number"), ("cluster", "value")),
    What.IN_PLACE: (("number", "number"),),
}
_INSTANTS = {
    Kind.LOST: What.LOST,
    Kind.SUPERSEDED: What.SUPERSEDED,
    Kind.EXPIRED: What.EXPIRED,
    Kind.BLOCKED: What.BLOCKED,
    Kind.MATCH: What.MATCH,
    Kind.JOIN: What.JOIN,
    Kind.LEAVE: What.LEAVE,
    Kind.HAND: What.HAND,
    Kind.ARRIVE: What.ARRIVE,
    Kind.DROP: What.DROP,
    Kind.IN_PLACE: What.IN_PLACE,
}

_TRANSFERS = (What.HAND, What.ARRIVE, What.DROP)

SLICE = np.dtype(
    [
        ("begin_ns", "<i8"),
        ("end_ns", "<i8"),  # if unknown, the last event of the thread
        ("what", "<u1"),
        ("is_instant", "?"),
        ("is_end_known", "?"),
        ("endpoint", "<u8"),  # acting endpoint, or NO_ID
        ("publisher", "<u8"),  # with `number`: the record of a publish, receive, take or callback
        ("number", "<u8"),
        ("value", "<u8"),  # size of a publish in bytes, or number of missed messages
    ]
)


def category_of(what: int) -> str:
    """Return the category shown by viewers."""
    return _WORDS[What(what)][0]


def name_of(trace: Trace, what: int, endpoint: EndpointId) -> str:
    """Return the name shown by viewers."""
    word = _WORDS[What(what)][1]
    return word if endpoint == NO_ID else f"{word} {trace.topic_of(endpoint)}"


def slices_of(thread: Thread) -> Slices:
    """Return the spans of a thread by start time; enclosing spans first."""
    events = thread.events
    if not len(events):
        return np.empty(0, SLICE)
    spans = _Spans(events)
    found = np.concatenate(
        [
            *spans.waits(),
            spans.serializing(),
            *spans.publishes(),
            *spans.takes(),
            *spans.callbacks(),
            spans.receives(),
            *spans.bridged(),
            *spans.matching(),
            *spans.instants(),
        ]
    )
    return found[np.lexsort((-found["end_ns"], found["begin_ns"]))]


class _Spans:
    """Spans of a thread's events, by kind."""

    def __init__(self, events: Events) -> None:
        self._events = events
        self._kinds = events["kind"]
        self._times = events["time_ns"]
        self._ids = endpoint_ids(events)
        self._last = len(events) - 1

    def _at(self, *kinds: Kind) -> Indices:
        return np.flatnonzero(np.isin(self._kinds, kinds))

    def _spans(self, what: What, begins: Indices, ends: Indices, *, known: bool = True) -> Slices:
        found = np.zeros(len(begins), SLICE)
        found["what"] = what
        found["begin_ns"] = self._times[begins]
        found["end_ns"] = self._times[ends]
        found["is_end_known"] = known
        found["endpoint"] = found["publisher"] = NO_ID
        return found

    def _unfinished(self, what: What, begins: Indices) -> Slices:
        return self._spans(what, begins, np.full(len(begins), self._last), known=False)

    def waits(self) -> Sequence[Slices]:
        begins, ends, open_begin = in_turns(self._at(Kind.WAIT_BEGIN), self._at(Kind.WAIT_END))
        return self._spans(What.WAIT, begins, ends), self._unfinished(What.WAIT, open_begin)

    def serializing(self) -> Slices:
        begins, ends, _ = in_turns(self._at(Kind.SERIALIZE_BEGIN), self._at(Kind.WRITE))
        return self._spans(What.SERIALIZE, begins, ends)

    def publishes(self) -> Sequence[Slices]:
        """From the start of each publish; if tracing started in between, from its write."""
        ends = self._at(Kind.PUBLISH_END, Kind.REFUSED)
        begins, ended, open_begin = in_turns(self._at(Kind.PUBLISH_BEGIN), ends)
        writes, late_ends, open_write = in_turns(self._at(Kind.WRITE), ends)
        late = ~np.isin(late_ends, ended)
        begins = np.concatenate([begins, writes[late]])
        ended = np.concatenate([ended, late_ends[late]])
        refused = self._kinds[ended] == Kind.REFUSED
        unfinished = self._unfinished(What.PUBLISH, open_begin if len(open_begin) else open_write)
        unfinished["value"] = self._events["value"][open_begin if len(open_begin) else open_write]
        if len(open_write):
            self._name_record(unfinished, open_write, self._ids[open_write])
        elif len(open_begin):
            unfinished["endpoint"] = self._ids[open_begin]
        done = self._publish(What.PUBLISH, begins[~refused], ended[~refused])
        self._name_record(done, ended[~refused], done["endpoint"])
        return done, self._publish(What.REFUSED, begins[refused], ended[refused]), unfinished

    def _publish(self, what: What, begins: Indices, ends: Indices) -> Slices:
        found = self._spans(what, begins, ends)
        found["endpoint"] = self._ids[ends]
        found["value"] = self._events["value"][begins]
        return found

    def _name_record(self, slices: Slices, at: Indices, publishers: NDArray[np.uint64]) -> None:
        slices["endpoint"] = self._ids[at]
        slices["publisher"] = publishers
        slices["number"] = self._events["number"][at]

    def _name_taken(self, slices: Slices, at: Indices) -> None:
        self._name_record(slices, at, endpoint_in(self._events["value"][at]))

    def takes(self) -> Sequence[Slices]:
        """From each claim to the release of the same record; a thread may hold several."""
        at = self._at(Kind.CLAIM, Kind.RELEASE)
        records = endpoint_in(self._events["value"][at]), self._events["number"][at]
        is_begin = self._kinds[at] == Kind.CLAIM
        begins, ends, open_begins = by_key(records, at, is_begin)
        done, unfinished = (
            self._spans(What.TAKE, begins, ends),
            self._unfinished(What.TAKE, open_begins),
        )
        self._name_taken(done, begins)
        self._name_taken(unfinished, open_begins)
        return done, unfinished

    def callbacks(self) -> Sequence[Slices]:
        """From the end of each take to the thread's next take or wait.

        A thread of a pool never waits: its last callback ends with its last event before the next
        take.
        """
        releases = self._at(Kind.RELEASE)
        begins, ends, open_begin = in_turns(releases, self._at(Kind.WAIT_BEGIN, Kind.CLAIM))
        waits = bool((self._kinds == Kind.WAIT_BEGIN).any())
        done = self._spans(What.CALLBACK, begins, ends if waits else ends - 1, known=waits)
        unfinished = self._unfinished(What.CALLBACK, open_begin)
        self._name_taken(done, begins)
        self._name_taken(unfinished, open_begin)
        return done, unfinished

    def receives(self) -> Slices:
        """From each receive to the last event before the next one."""
        at = self._at(Kind.RECEIVE)
        found = self._spans(What.RECEIVE, at, next_of(at, len(self._events)) - 1)
        self._name_record(found, at, self._ids[at])
        return found

    def bridged(self) -> Sequence[Slices]:
        """Outward: from claim to hand-over to DDS. Inward: until published on the platform."""
        at = self._at(Kind.BRIDGE_OUT, Kind.RELEASE)
        claims, ends, _ = in_turns(self._at(Kind.CLAIM), at)
        is_out = self._kinds[ends] == Kind.BRIDGE_OUT
        outwards = self._spans(What.BRIDGE_OUT, claims[is_out], ends[is_out])
        self._name_taken(outwards, claims[is_out])
        begins, ends, _ = in_turns(self._at(Kind.BRIDGE_IN), self._at(Kind.PUBLISH_END))
        inwards = self._spans(What.BRIDGE_IN, begins, ends)
        self._name_record(inwards, ends, self._ids[ends])
        inwards["value"] = self._events["value"][begins]
        return outwards, inwards

    def matching(self) -> Sequence[Slices]:
        """Alignments and passes of workers; their events are recorded at the end."""
        found = []
        for kind, what in ((Kind.ALIGN, What.ALIGN), (Kind.PASS, What.PASS)):
            at = self._at(kind)
            spans = self._spans(what, at, at)
            spans["begin_ns"] = self._events["number"][at]
            spans["end_ns"] = self._events["value"][at]
            spans["number"] = self._events["incarnation"][at]
            found.append(spans)
        return found

    def instants(self) -> Sequence[Slices]:
        return [self._instant(what, self._at(kind)) for kind, what in _INSTANTS.items()]

    def _instant(self, what: What, at: Indices) -> Slices:
        found = self._spans(what, at, at)
        found["is_instant"] = True
        found["endpoint"] = self._ids[at]
        if what in (What.LOST, What.SUPERSEDED, *_TRANSFERS):
            found["value"] = self._events["value"][at]
        if what in _TRANSFERS:
            self._name_record(found, at, self._ids[at])
        if what == What.IN_PLACE:
            self._name_taken(found, at)
        return found
