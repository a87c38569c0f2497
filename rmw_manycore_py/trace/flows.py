# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""The way of each message: from its publish, through the receive thread, to each take."""

from __future__ import annotations

from dataclasses import dataclass
from typing import NamedTuple

import numpy as np

from rmw_manycore_py.trace.events import (
    EndpointId,
    Events,
    Kind,
    Process,
    RecordId,
    Thread,
    Trace,
    endpoint_id,
    endpoint_in,
)


class Place(NamedTuple):
    """A moment in a thread."""

    thread: int  # index among the trace's threads
    time_ns: int


class Flow(NamedTuple):
    """One take of one message."""

    record: RecordId
    subscription: EndpointId
    write: Place
    receive: Place | None  # where the receive thread has it, between clusters
    claim: Place


@dataclass(frozen=True)
class Flows:
    """All flows of a trace, and the number of takes whose publish is not in it."""

    flows: tuple[Flow, ...]
    without_publish: int


def flows_of(trace: Trace) -> Flows:
    """Return exactly one flow for each take whose publish is in the trace."""
    threads = list(trace.threads())
    writes: dict[RecordId, Place] = {}
    receives: dict[tuple[RecordId, int], Place] = {}
    for index, (process, thread) in enumerate(threads):
        for event in _of_kind(thread, Kind.WRITE):
            writes[_record(event)] = Place(index, event[0])
        for event in _of_kind(thread, Kind.RECEIVE):
            # The first one: a receive thread may look twice, when its readers change meanwhile.
            receives.setdefault((_record(event), process.cluster), Place(index, event[0]))
    found = []
    without_publish = 0
    for index, (process, thread) in enumerate(threads):
        for event in _of_kind(thread, Kind.CLAIM):
            record = (endpoint_in(event[2]), event[1])
            write = writes.get(record)
            if write is None:
                without_publish += 1
                continue
            claim = Place(index, event[0])
            receive = receives.get((record, process.cluster))
            # A reader that looked for itself was not told by the receive thread.
            told = receive is not None and receive.time_ns <= claim.time_ns
            found.append(
                Flow(
                    record,
                    endpoint_id(event[3], event[4]),
                    write,
                    receive if told else None,
                    claim,
                )
            )
    return Flows(tuple(found), without_publish)


def _of_kind(thread: Thread, kind: Kind) -> list[tuple[int, int, int, int, int, int]]:
    events: list[tuple[int, int, int, int, int, int]] = thread.events[
        thread.events["kind"] == kind
    ].tolist()
    return events


def _record(event: tuple[int, int, int, int, int, int]) -> RecordId:
    return endpoint_id(event[3], event[4]), event[1]


def merged(threads: list[tuple[Process, Thread]], kinds: tuple[Kind, ...]) -> Events:
    """Return the events of these kinds of all threads, in the order of their times."""
    parts = [thread.events[np.isin(thread.events["kind"], kinds)] for _, thread in threads]
    events: Events = np.concatenate(parts) if parts else np.empty(0)
    return events[np.argsort(events["time_ns"], kind="stable")] if len(events) else events
