# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""Time series: queue lengths, losses, CPU usage and SMEM."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from rmw_manycore_py.trace.events import Events, Kind, Trace, endpoint_ids, endpoint_in
from rmw_manycore_py.trace.flows import merged
from rmw_manycore_py.trace.names import place_name
from rmw_manycore_py.trace.pairs import groups_of, split_by

# Kinds of events whose value is a number of messages that were not taken.
_MISSED = {Kind.LOST: "lost", Kind.SUPERSEDED: "superseded"}


@dataclass(frozen=True)
class Counter:
    """A value over time."""

    name: str
    times_ns: NDArray[np.int64]
    values: NDArray[np.float64]


def counters_of(trace: Trace) -> list[Counter]:
    """Return queue length and losses per subscription, CPU per core, SMEM per cluster."""
    return [*_queues(trace), *_losses(trace), *_cpu_shares(trace), *_smem(trace)]


def _queues(trace: Trace) -> Iterator[Counter]:
    kinds = (Kind.HINT, Kind.CLAIM, Kind.EXPIRED, *_MISSED)
    events = merged(list(trace.threads()), kinds)
    changes = _queue_changes(events)
    for name, own in _by_endpoint(trace, events):
        lengths = np.cumsum(changes[own])
        # Takes of messages queued before the trace began must not make the length negative.
        lengths -= np.minimum(np.minimum.accumulate(lengths), 0)
        yield Counter(f"queue {name}", events["time_ns"][own], lengths.astype(np.float64))


def _queue_changes(events: Events) -> NDArray[np.int64]:
    """Return the change of the queue length by each event.

    A record may have several hints, and takes may have none: each counts at most once.
    """
    subscriptions = endpoint_ids(events)
    records = groups_of((endpoint_in(events["value"]), events["number"])).astype(np.uint64)
    entries = groups_of((subscriptions, records))
    order = np.argsort(entries, kind="stable")
    is_there = events["kind"][order] == Kind.HINT
    was_there = np.append(False, is_there[:-1])
    was_there[np.append(True, np.diff(entries[order]) != 0)[: len(order)]] = False
    changes = np.empty(len(events), np.int64)
    changes[order] = is_there.astype(np.int64) - was_there
    is_missed = np.isin(events["kind"], list(_MISSED))
    changes[is_missed] = -events["value"][is_missed].astype(np.int64)
    return changes


def _losses(trace: Trace) -> Iterator[Counter]:
    for kind, word in _MISSED.items():
        events = merged(list(trace.threads()), (kind,))
        for name, own in _by_endpoint(trace, events):
            count = np.cumsum(events["value"][own]).astype(np.float64)
            yield Counter(f"{word} {name}", events["time_ns"][own], count)


def _cpu_shares(trace: Trace) -> Iterator[Counter]:
    """Yield the CPU usage of each process in percent between consecutive samples."""
    for process in trace.processes:
        events = merged([(process, thread) for thread in process.threads], (Kind.CPU,))
        spans_ns = np.diff(events["time_ns"])
        if not spans_ns.any():
            continue
        shares = 100 * np.diff(events["value"].astype(np.int64)) / np.maximum(spans_ns, 1)
        name = f"CPU % {place_name(process)}"
        if process.core is None and not process.is_receive_thread:
            name += f" ({process.label} {process.pid})"
        # Each value holds until the next sample.
        yield Counter(name, events["time_ns"], np.append(shares, 0.0))


def _smem(trace: Trace) -> Iterator[Counter]:
    """Yield the used SMEM of each cluster in bytes, as sampled by its processes."""
    events = merged(list(trace.threads()), (Kind.SMEM,))
    for own in split_by(events["number"]):
        changes = own[np.append(True, np.diff(events["value"][own]) != 0)]
        name = f"SMEM bytes cluster {events['number'][own[0]]}"
        yield Counter(name, events["time_ns"][changes], events["value"][changes].astype(np.float64))


def _by_endpoint(trace: Trace, events: Events) -> Iterator[tuple[str, NDArray[np.intp]]]:
    """Yield the name of each endpoint, and the indices of its events."""
    endpoints = endpoint_ids(events)
    for own in split_by(endpoints):
        endpoint = int(endpoints[own[0]])
        yield f"{trace.topic_of(endpoint)} {trace.node_of(endpoint)}", own
