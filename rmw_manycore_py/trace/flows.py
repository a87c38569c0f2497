# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""Path of each message: from its publish, through the receive thread, to each take."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from rmw_manycore_py.trace.events import (
    EVENT,
    Events,
    Ids,
    Kind,
    Process,
    Thread,
    Trace,
    endpoint_ids,
    endpoint_in,
)
from rmw_manycore_py.trace.pairs import Indices, first_of

NO_THREAD = -1

# One take of one message. Threads are indices into the trace's threads.
FLOW = np.dtype(
    [
        ("publisher", "<u8"),  # with `number`: the record
        ("number", "<u8"),
        ("subscription", "<u8"),
        ("write_thread", "<i4"),
        ("write_ns", "<i8"),
        ("receive_thread", "<i4"),  # NO_THREAD if no receive thread notified the subscription
        ("receive_ns", "<i8"),
        ("claim_thread", "<i4"),
        ("claim_ns", "<i8"),
    ]
)


@dataclass(frozen=True)
class Flows:
    """All flows of a trace, and the number of takes without a publish in the trace."""

    flows: NDArray[Any]  # of FLOW
    without_publish: int


class _Column(NamedTuple):
    """All events of a kind, with their records."""

    events: Events
    threads: NDArray[np.int32]
    clusters: NDArray[np.uint64]
    record: tuple[Ids, NDArray[np.uint64]]  # publishers and numbers


def flows_of(trace: Trace) -> Flows:
    """Return exactly one flow per take whose publish is in the trace."""
    writes = _column(trace, Kind.WRITE, endpoint_ids)
    receives = _column(trace, Kind.RECEIVE, endpoint_ids)
    claims = _column(trace, Kind.CLAIM, lambda events: endpoint_in(events["value"]))
    write = first_of(writes.record, claims.record)
    found = write >= 0
    write = write[found]
    flows = np.zeros(len(write), FLOW)
    flows["publisher"], flows["number"] = (key[found] for key in claims.record)
    flows["subscription"] = endpoint_ids(claims.events[found])
    flows["claim_thread"] = claims.threads[found]
    flows["claim_ns"] = claims.events["time_ns"][found]
    flows["write_thread"] = writes.threads[write]
    flows["write_ns"] = writes.events["time_ns"][write]
    # The first one: a receive thread handles a message twice if its readers change meanwhile.
    receive = first_of((*receives.record, receives.clusters), (*claims.record, claims.clusters))
    _add_receives(flows, receives, receive[found])
    return Flows(flows, int((~found).sum()))


def _add_receives(flows: NDArray[Any], receives: _Column, receive: Indices) -> None:
    """Drop receives after which a reader had already found the message itself."""
    flows["receive_thread"] = NO_THREAD
    told = np.flatnonzero(receive >= 0)
    told = told[receives.events["time_ns"][receive[told]] <= flows["claim_ns"][told]]
    flows["receive_thread"][told] = receives.threads[receive[told]]
    flows["receive_ns"][told] = receives.events["time_ns"][receive[told]]


def _column(trace: Trace, kind: Kind, publishers: Callable[[Events], Ids]) -> _Column:
    found = [(p, t.events[t.events["kind"] == kind]) for p, t in trace.threads()]
    events = joined([own for _, own in found])
    counts = [len(own) for _, own in found]
    clusters = np.array([process.cluster for process, _ in found], np.uint64)
    return _Column(
        events,
        np.repeat(np.arange(len(found), dtype=np.int32), counts),
        np.repeat(clusters, counts),
        (publishers(events), events["number"]),
    )


def joined(parts: Sequence[Events]) -> Events:
    """Return the concatenated events of several threads."""
    return np.concatenate([*parts, np.empty(0, EVENT)])


def merged(threads: list[tuple[Process, Thread]], kinds: tuple[Kind, ...]) -> Events:
    """Return the events of these kinds of all threads, in time order."""
    events = joined([t.events[np.isin(t.events["kind"], kinds)] for _, t in threads])
    return events[np.argsort(events["time_ns"], kind="stable")]
