# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""Watches a platform, also before its start and after its end."""

from __future__ import annotations

import time
from collections import deque
from collections.abc import Callable, Iterable
from dataclasses import dataclass, field

from rmw_manycore_py.errors import ManycoreError
from rmw_manycore_py.native import _transport
from rmw_manycore_py.platform.monitor import events
from rmw_manycore_py.platform.monitor.events import Event
from rmw_manycore_py.platform.monitor.graph import Graph, Member, read_graph
from rmw_manycore_py.platform.monitor.latency import TopicLatency, live_latencies
from rmw_manycore_py.platform.monitor.loads import Loads
from rmw_manycore_py.platform.monitor.losses import Losses
from rmw_manycore_py.platform.monitor.sample import Sample, take_sample
from rmw_manycore_py.platform.monitor.workers import Workers
from rmw_manycore_py.platform.virtual_clock import passed_s, virtual_clock

# Window for rates, so that a topic of 1 Hz does not flicker at two looks a second.
WINDOW_S = 2.0
_TRACE_PERIOD_S = 1.0


@dataclass(frozen=True)
class Look:
    """Snapshot of a platform, with all that the tools show."""

    loads: Loads  # over WINDOW_S
    dead: tuple[Member, ...]  # killed or crashed, not restarted
    workers: dict[int, tuple[int, ...]]  # worker pids by coordinator pid
    happened: tuple[Event, ...]  # since the previous look
    latencies: dict[str, TopicLatency]  # by topic; empty unless traced
    trace: _transport.TraceState | None
    virtual_s: float | None  # since the begin of a run in virtual time

    @property
    def graph(self) -> Graph:
        """The current graph."""
        return self.loads.graph


@dataclass
class _Seen:
    """State kept while a platform exists."""

    platform: _transport.Platform
    clock: Callable[[], int] | None = None  # of a run in virtual time
    generation: int = -1
    members: tuple[tuple[int, int], ...] = ()  # (slot, pid) when the graph was read
    graph: Graph | None = None
    workers: Workers = field(default_factory=Workers)
    losses: Losses = field(default_factory=Losses)
    samples: deque[Sample] = field(default_factory=deque)
    known: dict[tuple[int, int], Member] = field(default_factory=dict)  # by slot and pid
    dead: dict[tuple[int, int], Member] = field(default_factory=dict)
    deaths_until_ns: int = 0


class Watch:
    """Looks at a platform by name; never wakes or blocks its processes."""

    def __init__(self, name: str, window_s: float = WINDOW_S) -> None:
        self._name = name
        self._window_s = window_s
        self._seen: _Seen | None = None
        self._latencies: dict[str, TopicLatency] = {}
        self._trace: _transport.TraceState | None = None
        self._trace_due_s = 0.0
        self.last_words: tuple[Event, ...] = ()  # events at the end of the platform

    def look(self) -> Look | None:
        """Return a look; None while there is no such platform."""
        if self._seen is not None and not self._seen.platform.is_current():
            self._end(self._seen)
        if self._seen is None and not self._open():
            return None
        assert self._seen is not None
        try:
            return self._look_at(self._seen)
        except _transport.PlatformError:
            if self._seen.platform.is_current():
                raise
        self._end(self._seen)  # removed during the look
        return None

    def close(self) -> None:
        """Unmap the platform."""
        if self._seen is not None:
            self._seen.platform.close()
            self._seen = None

    def _open(self) -> bool:
        try:
            if self._name not in _transport.platforms():
                return False
            platform = _transport.Platform(self._name)
        except _transport.PlatformError:  # being created or removed; retry at the next look
            return False
        if not platform.is_current():  # being removed: some of its files are still there
            platform.close()
            return False
        self._seen = _Seen(platform, deaths_until_ns=time.monotonic_ns())
        return True

    def _end(self, seen: _Seen) -> None:
        dead = self._newly_dead(seen)
        ended = Event("platform", f"platform {self._name} has ended")
        losses = seen.losses.rest(time.monotonic())
        self.last_words = (*losses, *events.deaths(dead), ended)
        self._trace, self._latencies = None, {}
        self.close()

    def _look_at(self, seen: _Seen) -> Look:
        seen.clock = seen.clock or virtual_clock(self._name)
        graph = self._graph(seen)
        workers = seen.workers.of([member.pid for member in graph.members])
        sample = take_sample(seen.platform, graph, workers)
        previous = seen.samples[-1] if seen.samples else sample
        seen.samples.append(sample)
        while len(seen.samples) > 2 and sample.time_s - seen.samples[1].time_s >= self._window_s:
            seen.samples.popleft()
        self._look_at_trace()
        happened = self._happened(seen, Loads(previous, sample))  # updates the dead
        return Look(
            Loads(seen.samples[0], sample),
            tuple(seen.dead.values()),
            workers,
            happened,
            self._latencies,
            self._trace,
            passed_s(seen.clock),
        )

    def _graph(self, seen: _Seen) -> Graph:
        """Read the graph again if it has changed; processes without nodes change no generation."""
        generation = seen.platform.graph_generation()
        members = tuple((process.slot, process.pid) for process in seen.platform.processes())
        if seen.graph is None or generation != seen.generation or members != seen.members:
            seen.graph = read_graph(seen.platform, seen.graph)
            seen.generation, seen.members = generation, members
            seen.known.update({(m.slot, m.pid): m for m in seen.graph.members})
        return seen.graph

    def _newly_dead(self, seen: _Seen) -> list[Member]:
        """Return the processes that died since the previous look."""
        newly = []
        for death in seen.platform.deaths():
            member = seen.known.get((death.process, death.pid))
            if death.found_ns > seen.deaths_until_ns and member is not None:
                newly.append(member)
            seen.deaths_until_ns = max(seen.deaths_until_ns, death.found_ns)
        return newly

    def _happened(self, seen: _Seen, since: Loads) -> tuple[Event, ...]:
        newly = self._newly_dead(seen)
        seen.dead.update({(member.slot, member.pid): member for member in newly})
        seen.dead = _not_back(seen.dead, since.graph.members)
        living = {(member.slot, member.pid) for member in since.graph.members}
        seen.known = {key: m for key, m in seen.known.items() if key in living}
        return (
            *events.deaths(newly),
            *events.receive_thread_deaths(since),
            *seen.losses.events_of(since),
        )

    def _look_at_trace(self) -> None:
        if time.monotonic() < self._trace_due_s:
            return
        self._trace_due_s = time.monotonic() + _TRACE_PERIOD_S
        try:
            self._trace = _transport.trace_state(self._name)
            self._latencies = live_latencies(self._name, self._trace)
        except (_transport.PlatformError, ManycoreError):
            pass  # being saved or ending; retry at the next look


def _not_back(
    dead: dict[tuple[int, int], Member], living: Iterable[Member]
) -> dict[tuple[int, int], Member]:
    """Return the dead processes, except those whose nodes all run again.

    A process that died after the graph was read is still listed as living; it does not count.
    """
    if not dead:
        return dead
    others = (member for member in living if (member.slot, member.pid) not in dead)
    names = {name for member in others for name in member.shown_names}
    return {key: member for key, member in dead.items() if not names.issuperset(member.shown_names)}
