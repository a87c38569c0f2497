# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""Counters of a platform at any time of a trace, as they would have been read then."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Sequence
from dataclasses import dataclass
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from rmw_manycore_py.platform.monitor.sample import (
    BYTES,
    DEADLINES,
    EXPIRED,
    IN_PLACE,
    LOST,
    MESSAGES,
    REFUSED,
    SUPERSEDED,
    Sample,
)
from rmw_manycore_py.trace.events import Events, Kind, Process, Trace, endpoint_ids, endpoint_in
from rmw_manycore_py.trace.flows import merged
from rmw_manycore_py.trace.pairs import first_of, split_by
from rmw_manycore_py.view.trace_graph import TracedGraph

_COLUMNS = DEADLINES + 2  # of a row of counts
# Events of a kind that count in a column; whether their value is the number of messages.
_OTHERS = (
    (Kind.LOST, LOST, True),
    (Kind.SUPERSEDED, SUPERSEDED, True),
    (Kind.EXPIRED, EXPIRED, False),
    (Kind.REFUSED, REFUSED, False),
    (Kind.IN_PLACE, IN_PLACE, False),
)


class Moment(NamedTuple):
    """A time of a trace, and what its sample calls it."""

    time_ns: int
    time_s: float


class TracedCluster(NamedTuple):
    """A cluster, as far as a trace knows it."""

    id: int
    used_bytes: int
    receive_thread_pid: int
    messages: int
    alive: bool = True
    smem_bytes: int = 0  # unknown


@dataclass(frozen=True)
class _Counter:
    """What events add to a column of the counts."""

    column: int
    times_ns: NDArray[np.int64]
    rows: NDArray[np.intp]
    values: NDArray[np.float64]


@dataclass(frozen=True)
class _Course:
    """A value that was noted from time to time."""

    times_ns: NDArray[np.float64]  # np.interp would convert all of them each time
    values: NDArray[np.float64]

    @classmethod
    def of(cls, events: Events) -> _Course:
        """Return the course of the events' values."""
        return cls(events["time_ns"].astype(np.float64), events["value"].astype(np.float64))

    def at(self, time_ns: int) -> int:
        """Return the value, on the line between those before and after."""
        return int(np.interp(time_ns, self.times_ns, self.values)) if len(self.values) else 0


class TraceCounters:
    """All counters of a trace."""

    def __init__(self, trace: Trace, traced: TracedGraph) -> None:
        self._graph = traced.graph
        self._rows = traced.rows
        self._counters = tuple(self._counters_of(trace))
        self._cpu_ns = {process.pid: _course_of(process, Kind.CPU) for process in trace.processes}
        self._used_bytes = _smem_of(trace)
        receivers = [process for process in trace.processes if process.is_receive_thread]
        self._receivers = {process.cluster: process.pid for process in receivers}
        self._received_ns = {
            cluster: _times_of([one for one in receivers if one.cluster == cluster], Kind.RECEIVE)
            for cluster in self._receivers
        }
        clusters = {process.cluster for process in trace.processes}
        self._clusters = sorted(clusters | self._used_bytes.keys())

    def at(self, moments: Iterable[Moment]) -> Iterator[Sample]:
        """Yield the counters at moments of the trace, each no earlier than the one before."""
        counts = np.zeros((len(self._graph.endpoints), _COLUMNS), dtype=np.int64)
        begins = [0] * len(self._counters)
        for time_ns, time_s in moments:
            for index, one in enumerate(self._counters):
                end = int(np.searchsorted(one.times_ns, time_ns, side="right"))
                added = slice(begins[index], end)
                counts[:, one.column] += np.bincount(
                    one.rows[added], weights=one.values[added], minlength=len(counts)
                ).astype(np.int64)
                begins[index] = end
            clusters = tuple(self._cluster(number, time_ns) for number in self._clusters)
            cpu_ns = {pid: course.at(time_ns) for pid, course in self._cpu_ns.items()}
            yield Sample(time_s, self._graph, clusters, counts.copy(), cpu_ns)

    def _cluster(self, number: int, time_ns: int) -> TracedCluster:
        used = self._used_bytes.get(number)
        received_ns = self._received_ns.get(number, np.empty(0, np.int64))
        return TracedCluster(
            number,
            used.at(time_ns) if used else 0,
            self._receivers.get(number, 0),
            int(np.searchsorted(received_ns, time_ns, side="right")),
        )

    def _counters_of(self, trace: Trace) -> Iterator[_Counter]:
        threads = list(trace.threads())
        writes, claims = merged(threads, (Kind.WRITE,)), merged(threads, (Kind.CLAIM,))
        written = (endpoint_ids(writes), writes["number"])
        taken = first_of(written, (endpoint_in(claims["value"]), claims["number"]))
        sizes = np.append(writes["value"], 0)[taken]  # of messages from before the trace: 0
        yield self._counter(MESSAGES, writes)
        yield self._counter(BYTES, writes, writes["value"])
        yield self._counter(MESSAGES, claims)
        yield self._counter(BYTES, claims, sizes)
        for kind, column, is_number in _OTHERS:
            events = merged(threads, (kind,))
            yield self._counter(column, events, events["value"] if is_number else None)

    def _counter(
        self, column: int, events: Events, values: NDArray[np.generic] | None = None
    ) -> _Counter:
        """Return a counter of the events whose endpoints have names.

        :param values: what each event adds; None: 1.
        """
        rows = np.array([self._rows.get(one, -1) for one in endpoint_ids(events).tolist()], np.intp)
        is_known = rows >= 0
        added = np.ones(len(events)) if values is None else values.astype(np.float64)
        return _Counter(column, events["time_ns"][is_known], rows[is_known], added[is_known])


def _times_of(processes: Sequence[Process], kind: Kind) -> NDArray[np.int64]:
    threads = [(process, thread) for process in processes for thread in process.threads]
    times_ns: NDArray[np.int64] = merged(threads, (kind,))["time_ns"]
    return times_ns


def _course_of(process: Process, kind: Kind) -> _Course:
    return _Course.of(merged([(process, thread) for thread in process.threads], (kind,)))


def _smem_of(trace: Trace) -> dict[int, _Course]:
    events = merged(list(trace.threads()), (Kind.SMEM,))
    return {
        int(events["number"][own[0]]): _Course.of(events[own]) for own in split_by(events["number"])
    }
