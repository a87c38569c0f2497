# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""Profiles of what this project's tracer has recorded."""

from __future__ import annotations

from array import array
from collections import defaultdict
from collections.abc import Sequence
from dataclasses import dataclass, field

from rmw_manycore_py.profile.distributions import SHARES, distribution_of, intervals_of
from rmw_manycore_py.profile.model import (
    FORMAT,
    VERSION,
    Callback,
    CallbackKind,
    Coverage,
    Distribution,
    Node,
    Output,
    Process,
    Profile,
    Publisher,
    Subscription,
    indices_of,
)
from rmw_manycore_py.profile.overheads import Rest, receive_ns
from rmw_manycore_py.profile.periods import is_one_timer, nominal_ns
from rmw_manycore_py.profile.turns import Outside, Publication, Turn, turns_of
from rmw_manycore_py.trace.events import Endpoint, EndpointId, Kind, ThreadId, Trace

_KINDS: dict[str, CallbackKind] = {"topic": "subscription", "request": "service", "reply": "client"}
_LOG_TOPIC = "/rosout"
_Key = tuple[object, ...]


@dataclass
class _Seen:
    """A callback and its executions."""

    kind: CallbackKind
    node: str
    trigger: str
    endpoint: EndpointId | None
    process: int
    threads: set[int] = field(default_factory=set)
    turns: list[Turn] = field(default_factory=list)

    @property
    def due_ns(self) -> list[int]:
        """Times at which a timer was due, where they are known."""
        return [one.due_ns for one in self.turns if one.due_ns is not None]

    @property
    def interval_ns(self) -> Distribution | None:
        """From begin to begin."""
        return intervals_of(array("q", [one.begin_ns for one in self.turns]))

    @property
    def period_ns(self) -> int | None:
        """Of a timer."""
        interval_ns = self.interval_ns
        if self.kind != "timer" or interval_ns is None:
            return None
        return nominal_ns(self.due_ns, interval_ns.quantiles[SHARES.index(0.5)])

    def add(self, other: _Seen) -> None:
        """Add the executions of a timer that published other topics in these."""
        self.threads |= other.threads
        self.turns = sorted(self.turns + other.turns, key=lambda one: one.begin_ns)


def profile_of(trace: Trace, begin_ns: int, end_ns: int) -> Profile:
    """Return the profile of a trace between two times of CLOCK_MONOTONIC."""
    return _Recorded(trace, begin_ns, end_ns).profile()


class _Recorded:
    def __init__(self, trace: Trace, begin_ns: int, end_ns: int) -> None:
        self._trace = trace
        self._span_ns = end_ns - begin_ns
        self._receive_ns = receive_ns(trace, begin_ns, end_ns)
        endpoints = trace.endpoints
        self._nodes = indices_of(one.node for one in endpoints.values() if one.node)
        topics = {key: one for key, one in endpoints.items() if one.role == "topic"}
        self._publishers = indices_of(key for key, one in topics.items() if one.is_publisher)
        self._subscriptions = indices_of(key for key, one in topics.items() if not one.is_publisher)
        self._tids: dict[tuple[int, int], list[int]] = defaultdict(list)  # by cluster and pid
        self._rests: dict[tuple[int, int], Rest] = defaultdict(Rest)
        self._callbacks: dict[_Key, _Seen] = {}
        self._published: dict[EndpointId, list[Publication]] = defaultdict(list)
        self._outside: dict[EndpointId, int] = defaultdict(int)
        self._unfinished = 0
        self._process_of_node: dict[str, int] = {}
        for thread, events in trace.threads_by_id().items():
            within = events[(events["time_ns"] >= begin_ns) & (events["time_ns"] <= end_ns)]
            if len(within) and _takes_or_publishes(within["kind"].tolist()):
                self._follow(thread, within.tolist())
        self._unite_timers()

    def _follow(self, thread: ThreadId, rows: list[tuple[int, int, int, int, int, int]]) -> None:
        process = (thread[0], thread[1])
        tids = self._tids[process]
        tids.append(thread[2])
        index = list(self._tids).index(process)
        outside = Outside()
        turns = list(turns_of(rows, outside))
        self._rests[process].add(rows, turns)
        for turn in turns:
            turn.publications = [one for one in turn.publications if self._is_topic(one)]
            if turn.is_callback:
                self._add(turn, index, len(tids) - 1)
        for publication in filter(self._is_topic, outside.publications):
            self._published[publication.endpoint].append(publication)
            self._outside[publication.endpoint] += 1
            self._process_of_node[self._trace.node_of(publication.endpoint)] = index

    def _is_topic(self, publication: Publication) -> bool:
        return publication.endpoint in self._publishers

    def _add(self, turn: Turn, process: int, thread: int) -> None:
        for publication in turn.publications:
            self._published[publication.endpoint].append(publication)
        if turn.end_ns is None:
            self._unfinished += 1
            return
        seen = self._seen(turn, process)
        seen.threads.add(thread)
        seen.turns.append(turn)
        if seen.node:
            self._process_of_node[seen.node] = process

    def _seen(self, turn: Turn, process: int) -> _Seen:
        """Return the callback; the topics that a timer publishes, logs aside, identify it."""
        endpoint = self._trace.endpoints.get(-1 if turn.trigger is None else turn.trigger)
        outputs = {one.endpoint for one in turn.publications}
        identity = frozenset(one for one in outputs if self._trace.topic_of(one) != _LOG_TOPIC)
        key: _Key = (process, turn.trigger, None if endpoint else identity)
        if key not in self._callbacks:
            if endpoint is not None:
                kind, node, trigger = _KINDS[endpoint.role], endpoint.node, endpoint.topic
            else:
                kind = "timer" if turn.trigger is None else "unknown"
                node = self._trace.node_of(min(outputs)) if outputs else ""
                trigger = ""
            self._callbacks[key] = _Seen(kind, node, trigger, turn.trigger, process)
        return self._callbacks[key]

    def _unite_timers(self) -> None:
        """Unite what one timer did: what it publishes may change, when it is due does not."""
        timers: list[tuple[_Seen, int]] = []
        ordered = sorted(self._callbacks.items(), key=lambda one: len(one[1].turns), reverse=True)
        for key, seen in ordered:
            period_ns = seen.period_ns
            if period_ns is None:
                continue
            for other, other_ns in timers:
                near = seen.process == other.process and "" in (seen.node, other.node)
                if (near or seen.node == other.node) and is_one_timer(
                    other_ns, other.due_ns, seen.due_ns
                ):
                    other.add(seen)
                    other.node = other.node or seen.node
                    del self._callbacks[key]
                    break
            else:
                timers.append((seen, period_ns))

    def profile(self) -> Profile:
        labels = {(one.cluster, one.pid): one.label for one in self._trace.processes}
        endpoints = self._trace.endpoints
        return Profile(
            format=FORMAT,
            version=VERSION,
            source="manycore_trace",
            events=self._trace.event_count,
            duration_ns=self._span_ns,
            quantile_shares=SHARES,
            processes=tuple(
                Process(name=labels[key], threads=len(tids), rest_ns=self._rests[key].mean_ns)
                for key, tids in self._tids.items()
            ),
            nodes=tuple(
                Node(name=name, process=self._process_of_node.get(name)) for name in self._nodes
            ),
            publishers=tuple(self._publisher(key, endpoints[key]) for key in self._publishers),
            subscriptions=tuple(
                Subscription(
                    node=self._nodes.get(endpoints[key].node),
                    topic=endpoints[key].topic,
                    queue_depth=None,
                )
                for key in self._subscriptions
            ),
            executors=(),
            groups=(),
            callbacks=tuple(map(self._callback, self._callbacks.values())),
            chains=(),
            coverage=Coverage(
                discarded_events=self._trace.lost,
                unfinished=self._unfinished,
                publications_outside_callbacks=sum(self._outside.values()),
            ),
            receive_ns=self._receive_ns,
        )

    def _publisher(self, key: EndpointId, endpoint: Endpoint) -> Publisher:
        published = self._published[key]
        return Publisher(
            node=self._nodes.get(endpoint.node),
            topic=endpoint.topic,
            queue_depth=None,
            publications=len(published),
            outside_callbacks=self._outside[key],
            interval_ns=intervals_of(array("q", [one.at_ns for one in published])),
            size_bytes=distribution_of(array("q", [one.size_bytes for one in published])),
            publish_ns=distribution_of(array("q", [one.publish_ns for one in published])),
        )

    def _callback(self, seen: _Seen) -> Callback:
        turns = seen.turns
        dispatch_ns = [one.dispatch_ns for one in turns if one.dispatch_ns is not None]
        cpu_ns = [round(one.cpu_ns) for one in turns if one.cpu_ns is not None]
        return Callback(
            kind=seen.kind,
            node=self._nodes.get(seen.node or self._only_node(seen.process)),
            trigger=seen.trigger,
            subscription=self._subscriptions.get(-1 if seen.endpoint is None else seen.endpoint),
            period_ns=seen.period_ns,
            symbol="",
            process=seen.process,
            threads=tuple(sorted(seen.threads)),
            group=None,
            executions=len(turns),
            rate_hz=len(turns) * 1e9 / self._span_ns,
            wall_ns=distribution_of(array("q", [one.wall_ns for one in turns])),
            cpu_ns=distribution_of(array("q", cpu_ns)),
            interval_ns=seen.interval_ns,
            publishes=self._outputs(turns),
            dispatch_ns=distribution_of(array("q", dispatch_ns)),
        )

    def _only_node(self, process: int) -> str:
        """Return the node of a process that has one, for timers that publish nothing."""
        names = [name for name, its in self._process_of_node.items() if its == process]
        return names[0] if len(names) == 1 else ""

    def _outputs(self, turns: Sequence[Turn]) -> tuple[Output, ...]:
        offsets_ns: dict[EndpointId, array[int]] = {}
        for turn in turns:
            for one in turn.publications:
                own = offsets_ns.setdefault(one.endpoint, array("q"))
                own.append(one.at_ns - turn.begin_ns)
        return tuple(
            Output(
                publisher=self._publishers[endpoint],
                count=len(own),
                offset_ns=distribution_of(own),
            )
            for endpoint, own in offsets_ns.items()
        )


def _takes_or_publishes(kinds: list[int]) -> bool:
    return not {Kind.RELEASE, Kind.WRITE}.isdisjoint(kinds)
