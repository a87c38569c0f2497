# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""Chains: messages that a node published while it worked on one that it had taken.

Times are those of CARET: a message is on its way from the call of publish to the begin of the
callback (communication), and a node has it from there to its own call of publish (node).
"""

from __future__ import annotations

from collections import defaultdict
from dataclasses import dataclass
from functools import cached_property

from rmw_manycore_py.trace.events import (
    EndpointId,
    Kind,
    RecordId,
    Thread,
    Trace,
    endpoint_id,
    endpoint_in,
)

Chain = tuple[str, ...]  # topics, from the first to the last
MAX_LENGTH = 32  # topics of a chain


@dataclass(frozen=True)
class Arrival:
    """A message that has come to a node: its callback begins."""

    record: RecordId
    node: str
    callback_ns: int


@dataclass(frozen=True)
class Passage:
    """A message that went through a chain, to the begin of the last callback."""

    published_ns: tuple[int, ...]  # at each topic of the chain
    callback_ns: tuple[int, ...]
    nodes: tuple[str, ...]  # that took it
    first: RecordId


class Messages:
    """All messages of a trace: when they were published, why, and who took them."""

    def __init__(self, trace: Trace) -> None:
        self._trace = trace
        self.published_ns: dict[RecordId, int] = {}
        self.causes: dict[RecordId, Arrival] = {}
        self.arrivals: dict[str, list[Arrival]] = defaultdict(list)  # by topic
        for _, thread in trace.threads():
            self._follow(thread)
        for arrivals in self.arrivals.values():
            arrivals.sort(key=lambda arrival: arrival.callback_ns)

    def _is_of_topic(self, endpoint: EndpointId) -> bool:
        named = self._trace.endpoints.get(endpoint)
        return named is not None and named.role == "topic"

    def _follow(self, thread: Thread) -> None:
        current: Arrival | None = None
        begin_ns: int | None = None
        for time_ns, number, value, slot, incarnation, kind in thread.events.tolist():
            endpoint = endpoint_id(slot, incarnation)
            if kind in (Kind.WAIT_BEGIN, Kind.CLAIM):
                current = None
            elif kind == Kind.RELEASE and self._is_of_topic(endpoint):
                record = (endpoint_in(value), number)
                current = Arrival(record, self._trace.node_of(endpoint), time_ns)
                self.arrivals[self._trace.topic_of(endpoint)].append(current)
            elif kind == Kind.PUBLISH_BEGIN:
                begin_ns = time_ns
            elif kind == Kind.WRITE and self._is_of_topic(endpoint):
                record = (endpoint, number)
                self.published_ns[record] = time_ns if begin_ns is None else begin_ns
                begin_ns = None
                if current is not None and current.node == self._trace.node_of(endpoint):
                    self.causes[record] = current

    def topic_of(self, record: RecordId) -> str:
        """Return the topic that a message was published on."""
        return self._trace.topic_of(record[0])

    @cached_property
    def chains(self) -> list[Chain]:
        """The longest chains, by their topics, from what no other message caused."""
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
        """Return what went through a chain, in the order of its arrivals."""
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
            return None  # published before the trace began, or lost by it
        return Passage(
            known,
            tuple(arrival.callback_ns for arrival in arrivals),
            tuple(arrival.node for arrival in arrivals),
            arrivals[0].record,
        )
