# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""Numbers in a trace: messages and bytes of each publisher, and CPU time of each process."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from functools import cached_property
from typing import NamedTuple

import numpy as np

from rmw_manycore_py.errors import ManycoreError
from rmw_manycore_py.mapfile.mapping.crossing import Publication, Traffic
from rmw_manycore_py.platform.monitor.graph import EVERY_NODES_TOPICS
from rmw_manycore_py.profile.overheads import process_cpu_ns, receive_ns
from rmw_manycore_py.trace.events import Endpoint, Events, Kind, Process, Trace, endpoint_ids
from rmw_manycore_py.trace.flows import merged
from rmw_manycore_py.trace.names import nodes_of
from rmw_manycore_py.trace.pairs import split_by

_NS_PER_S = 1e9
_NEVER_NS = 1 << 63


class Count(NamedTuple):
    """Publications of a publisher."""

    messages: int
    size_bytes: int
    largest_bytes: int


@dataclass(frozen=True)
class ProcessLoad:
    """CPU time of a process; `cpu_share` 1.0 is one CPU."""

    process: Process
    nodes: tuple[str, ...]
    cpu_share: float


@dataclass(frozen=True)
class Recorded:
    """Numbers of a trace from when all nodes have started until its last publication.

    A node has started when it first waits for work: until then it takes all of a CPU, which is not
    what mappings and predictions are about.
    """

    trace: Trace
    begin_ns: int
    end_ns: int

    @classmethod
    def of(cls, trace: Trace) -> Recorded:
        """Return the numbers of a trace; raise ManycoreError if nothing was published.

        A node that starts again does not count as the last one. What a node logs while it ends
        does not count as the last publication.
        """
        begin_ns, end_ns = _publishing_ns(trace)
        started_ns = max(_starts_ns(trace), default=begin_ns)
        return cls(trace, started_ns if started_ns < end_ns else begin_ns, end_ns)

    @property
    def seconds(self) -> float:
        """Length of the time that is counted."""
        return (self.end_ns - self.begin_ns) / _NS_PER_S

    def per_s(self, amount: float) -> float:
        """Return a rate; 0 if all happened at one instant."""
        return amount / self.seconds if self.seconds else 0.0

    @cached_property
    def publications(self) -> dict[int, Count]:
        """Publications of topics by endpoint."""
        found: dict[int, Count] = {}
        for events in _events(self.trace, Kind.WRITE):
            within = self._within(events)
            ids = endpoint_ids(within)
            for own in split_by(ids):
                endpoint = int(ids[own[0]])
                if self.topic(endpoint) is None:
                    continue
                sizes = within["value"][own].astype(np.int64)
                known = found.get(endpoint, Count(0, 0, 0))
                found[endpoint] = Count(
                    known.messages + len(sizes),
                    known.size_bytes + int(sizes.sum()),
                    max(known.largest_bytes, int(sizes.max())),
                )
        return found

    def topic(self, endpoint: int) -> Endpoint | None:
        """Return an endpoint that is of a topic, not of a service."""
        named = self.trace.endpoints.get(endpoint)
        return named if named is not None and named.role == "topic" else None

    def subscriptions(self) -> Iterator[Endpoint]:
        """Yield the subscriptions of topics that have an event in the trace."""
        for endpoint in self.trace.endpoints:
            named = self.topic(endpoint)
            if named is not None and not named.is_publisher:
                yield named

    def traffic(self) -> Traffic:
        """Return the traffic between the clusters of the trace."""
        publications = [
            Publication(named.topic, named.cluster, count.messages, count.size_bytes)
            for endpoint, count in self.publications.items()
            if (named := self.topic(endpoint)) is not None
        ]
        return Traffic.of(publications, ((one.topic, one.cluster) for one in self.subscriptions()))

    def loads(self) -> Iterator[ProcessLoad]:
        """Yield the CPU usage of each process."""
        for process in self.trace.processes:
            yield ProcessLoad(
                process, tuple(nodes_of(self.trace, process)), self.per_s(self._cpu_s(process))
            )

    def peak_smem_bytes(self) -> dict[int, int]:
        """Return the peak of SMEM in use, by cluster, with all rings and chunks."""
        samples = merged(list(self.trace.threads()), (Kind.SMEM,))
        return {
            int(samples["number"][own[0]]): int(samples["value"][own].max())
            for own in split_by(samples["number"])
        }

    def receive_cpu_s(self) -> float | None:
        """Return the CPU time of a receive thread per message; None without a message."""
        each_ns = receive_ns(self.trace, self.begin_ns, self.end_ns)
        return None if each_ns is None else each_ns / _NS_PER_S

    def _cpu_s(self, process: Process) -> float:
        return process_cpu_ns(process, self.begin_ns, self.end_ns) / _NS_PER_S

    def _within(self, events: Events) -> Events:
        times = events["time_ns"]
        return events[(times >= self.begin_ns) & (times <= self.end_ns)]


def _events(trace: Trace, kind: Kind) -> Iterator[Events]:
    """Yield the events of a kind, thread by thread."""
    for _, thread in trace.threads():
        yield thread.events[thread.events["kind"] == kind]


def _publishing_ns(trace: Trace) -> tuple[int, int]:
    """Return the times of the first and the last message, of topics if there are any."""
    found: dict[bool, list[int]] = {True: [], False: []}
    for events in _events(trace, Kind.WRITE):
        ids = endpoint_ids(events)
        for own in split_by(ids):
            endpoint = int(ids[own[0]])
            named = trace.endpoints.get(endpoint)
            is_topic = named is not None and named.role == "topic"
            is_own = is_topic and trace.topic_of(endpoint) not in EVERY_NODES_TOPICS
            found[is_own] += events["time_ns"][own[[0, -1]]].tolist()
    chosen = found[True] or found[False]
    if not chosen:
        raise ManycoreError("the trace has no published message: trace for longer")
    return min(chosen), max(chosen)


def _starts_ns(trace: Trace) -> Iterator[int]:
    """Yield when a process first waited for work at each place that has a core.

    Those that had joined before the trace had started. One that never waits starts by joining.
    """
    joins: dict[tuple[int, int, str], int] = {}
    waits: dict[tuple[int, int, str], int] = {}
    for process in trace.processes:
        if process.core is not None:
            place = (process.cluster, process.core, process.label)
            for found, kind in ((joins, Kind.JOIN), (waits, Kind.WAIT_BEGIN)):
                first_ns = min(found.get(place, _NEVER_NS), _first_ns(process, kind))
                if first_ns < _NEVER_NS:
                    found[place] = first_ns
    for place, join_ns in joins.items():
        yield waits.get(place, join_ns)


def _first_ns(process: Process, kind: Kind) -> int:
    """Return when the first event of a kind happened; `_NEVER_NS` if none has."""
    own = (thread.events[thread.events["kind"] == kind] for thread in process.threads)
    return min((int(events["time_ns"][0]) for events in own if len(events)), default=_NEVER_NS)
