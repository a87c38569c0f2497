# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""Chains: messages that a node publishes while it handles a message it has taken.

Times follow CARET: communication latency is from the call of publish to the start of the callback,
node latency from there to the node's own call of publish.
"""

from __future__ import annotations

from bisect import bisect_right
from collections import defaultdict
from collections.abc import Mapping
from dataclasses import dataclass
from functools import cached_property
from itertools import pairwise

from rmw_manycore_py.trace.events import (
    EndpointId,
    Kind,
    RecordId,
    Row,
    ThreadId,
    Trace,
    endpoint_id,
    endpoint_in,
)
from rmw_manycore_py.trace.matching import Matching, Matchings

Chain = tuple[str, ...]  # topics from first to last
MAX_LENGTH = 32  # topics of a chain


@dataclass(frozen=True)
class Arrival:
    """Arrival of a message at a node: the start of its callback."""

    record: RecordId
    node: str
    callback_ns: int  # for a bridge, when it has the message
    bridged_ns: int | None = None  # handed to DDS


@dataclass(frozen=True)
class Passage:
    """A message's passage through a chain, up to the start of the last callback."""

    published_ns: tuple[int, ...]  # at each topic of the chain
    callback_ns: tuple[int, ...]
    nodes: tuple[str, ...]  # nodes that took it
    first: RecordId
    matching_ns: tuple[Matching | None, ...]  # per hop through a node
    age_ns: int | None  # age when the bridge published it inside
    bridged_ns: int | None  # when the last node, a bridge, had forwarded it


class CausedMessages:
    """Messages with publish times, causes and takes; topics by publisher."""

    def __init__(self, topics: Mapping[EndpointId, str]) -> None:
        self._topics = topics
        self.published_ns: dict[RecordId, int] = {}
        self.causes: dict[RecordId, Arrival] = {}
        self.arrivals: dict[str, list[Arrival]] = defaultdict(list)  # by topic
        self._ages_ns: dict[RecordId, int] = {}  # of messages from the bridge

    def sort(self) -> None:
        """Sort the arrivals; call it when all are known."""
        for arrivals in self.arrivals.values():
            arrivals.sort(key=lambda arrival: arrival.callback_ns)

    def topic_of(self, record: RecordId) -> str:
        """Return the topic of a message."""
        return self._topics[record[0]]

    @cached_property
    def chains(self) -> list[Chain]:
        """Longest chains, by topics, from messages without a cause."""
        following: dict[str, set[str]] = defaultdict(set)
        for record, cause in self.causes.items():
            following[self.topic_of(cause.record)].add(self.topic_of(record))
        later = set().union(*following.values())
        first = sorted(topic for topic in self.arrivals if topic not in later)
        found: list[Chain] = []
        open_chains: list[Chain] = [(topic,) for topic in first]
        while open_chains:
            chain = open_chains.pop()
            longer = sorted(
                topic
                for topic in following[chain[-1]]
                if topic not in chain and topic in self.arrivals and len(chain) < MAX_LENGTH
            )
            open_chains += [(*chain, topic) for topic in longer]
            if not longer:
                found.append(chain)
        return sorted(found)

    def passages(self, chain: Chain) -> list[Passage]:
        """Return the passages through a chain, in order of arrival."""
        found = []
        for arrival in self.arrivals.get(chain[-1], ()):
            passage = self._passage(chain, arrival)
            if passage is not None:
                found.append(passage)
        return found

    def _passage(self, chain: Chain, last: Arrival) -> Passage | None:
        arrivals = [last]
        for topic in reversed(chain[:-1]):
            cause = self.causes.get(arrivals[-1].record)
            if cause is None or self.topic_of(cause.record) != topic:
                return None
            arrivals.append(cause)
        arrivals.reverse()
        published = [self.published_ns.get(arrival.record) for arrival in arrivals]
        known = tuple(time_ns for time_ns in published if time_ns is not None)
        if len(known) != len(arrivals):
            return None  # published before the trace began, or event lost
        return Passage(
            known,
            tuple(arrival.callback_ns for arrival in arrivals),
            tuple(arrival.node for arrival in arrivals),
            arrivals[0].record,
            tuple(self._matching(before, after) for before, after in pairwise(arrivals)),
            self._ages_ns.get(arrivals[0].record),
            last.bridged_ns,
        )

    def _matching(self, *_: Arrival) -> Matching | None:
        """Return a node's scan matching between a take and its publish, if it is known."""
        return None


class Messages(CausedMessages):
    """All messages of a trace."""

    def __init__(self, trace: Trace) -> None:
        super().__init__({})
        self._trace = trace
        self._matchings = Matchings(trace)
        self._threads: dict[RecordId, ThreadId] = {}  # publishing thread
        threads = {key: events.tolist() for key, events in trace.threads_by_id().items()}
        self._of_thread = {key: self._arrivals_in(rows) for key, rows in threads.items()}
        for key, rows in threads.items():
            self._follow(key, rows)
        self.sort()

    def topic_of(self, record: RecordId) -> str:
        """Return the topic of a message."""
        return self._trace.topic_of(record[0])

    def _is_of_topic(self, endpoint: EndpointId) -> bool:
        named = self._trace.endpoints.get(endpoint)
        return named is not None and named.role == "topic"

    def _arrivals_in(self, rows: list[Row]) -> list[tuple[int, Arrival]]:
        """Return the takes of a thread, with their end times."""
        found = []
        claimed_ns = 0
        bridged_ns: int | None = None
        for time_ns, number, value, slot, incarnation, kind in rows:
            endpoint = endpoint_id(slot, incarnation)
            if kind == Kind.CLAIM:
                claimed_ns, bridged_ns = time_ns, None
            elif kind == Kind.BRIDGE_OUT:
                bridged_ns = time_ns
            elif kind == Kind.RELEASE and self._is_of_topic(endpoint):
                record = (endpoint_in(value), number)
                begin_ns = time_ns if bridged_ns is None else claimed_ns
                arrival = Arrival(record, self._trace.node_of(endpoint), begin_ns, bridged_ns)
                self.arrivals[self._trace.topic_of(endpoint)].append(arrival)
                found.append((time_ns, arrival))
        return found

    def _follow(self, thread: ThreadId, rows: list[Row]) -> None:
        arrivals = iter(self._of_thread[thread])
        current: Arrival | None = None
        begin_ns: int | None = None
        age_ns: int | None = None
        for time_ns, number, value, slot, incarnation, kind in rows:
            endpoint = endpoint_id(slot, incarnation)
            if kind in (Kind.WAIT_BEGIN, Kind.CLAIM):
                current = None
            elif kind == Kind.RELEASE and self._is_of_topic(endpoint):
                _, current = next(arrivals)
            elif kind == Kind.RESUME:
                current = self._arrival_before((*thread[:2], slot), number)
            elif kind == Kind.BRIDGE_IN:
                age_ns = value
            elif kind == Kind.PUBLISH_BEGIN:
                begin_ns = time_ns
            elif kind == Kind.WRITE and self._is_of_topic(endpoint):
                record = (endpoint, number)
                self.published_ns[record] = time_ns if begin_ns is None else begin_ns
                self._threads[record] = thread
                if age_ns is not None:
                    self._ages_ns[record] = age_ns
                begin_ns = age_ns = None
                if current is not None and current.node == self._trace.node_of(endpoint):
                    self.causes[record] = current

    def _arrival_before(self, thread: ThreadId, time_ns: int) -> Arrival | None:
        arrivals = self._of_thread.get(thread, [])
        at = bisect_right(arrivals, time_ns, key=lambda arrival: arrival[0])
        return arrivals[at - 1][1] if at else None

    def _matching(self, *hop: Arrival) -> Matching | None:
        before, after = hop
        thread = self._threads[after.record]
        return self._matchings.between(thread, before.callback_ns, self.published_ns[after.record])
