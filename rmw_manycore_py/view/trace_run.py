# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""Looks, history and events of a trace of a real or simulated run."""

from __future__ import annotations

import math
from collections import deque
from collections.abc import Iterable, Iterator
from dataclasses import replace
from functools import cached_property
from typing import Any

from rmw_manycore_py.errors import ManycoreError
from rmw_manycore_py.picture.chip import Chip
from rmw_manycore_py.platform.monitor.events import Event
from rmw_manycore_py.platform.monitor.latency import topic_latencies
from rmw_manycore_py.platform.monitor.loads import Loads
from rmw_manycore_py.platform.monitor.losses import Losses
from rmw_manycore_py.platform.monitor.sample import Sample
from rmw_manycore_py.platform.monitor.watch import WINDOW_S, Look
from rmw_manycore_py.trace.events import Trace
from rmw_manycore_py.view.history import LENGTH, History
from rmw_manycore_py.view.trace_counters import Moment, TraceCounters
from rmw_manycore_py.view.trace_graph import traced_graph
from rmw_manycore_py.view.tracing import chain_rows

LAST_STEP = LENGTH - 1
_NS_PER_S = 1e9
_MAX_WINDOW_SHARE = 0.25  # of the trace: rates are measured over at most this part of it


class TraceRun:
    """Looks at a trace: at `LENGTH` steps, evenly spaced from begin to end, or at the whole."""

    def __init__(self, trace: Trace, name: str) -> None:
        """Read a trace.

        :param name: of its file.
        :raises ManycoreError: if it has no events.
        """
        ends_ns = [
            int(thread.events["time_ns"][at])
            for _, thread in trace.threads()
            if len(thread.events)
            for at in (0, -1)
        ]
        if not ends_ns:
            raise ManycoreError(f"{name}: the trace has no events")
        self._begin_ns = min(ends_ns)
        self._trace = trace
        self.name = name
        self.duration_s = (max(ends_ns) - self._begin_ns) / _NS_PER_S
        self._counters = TraceCounters(trace, traced_graph(trace))
        self._latencies = topic_latencies(trace)
        self.whole = self._look_from(0, LAST_STEP)
        self.chip = Chip.of(self.whole)
        self.history = History()
        self.events: list[Event] = []
        self._watch()

    @property
    def title(self) -> str:
        """The file, and what it holds."""
        lost = f", {self._trace.lost:,} lost" if self._trace.lost else ""
        return f"{self.name}: {self.duration_s:.1f} s, {self._trace.event_count:,} events{lost}"

    def look_at(self, step: int) -> Look:
        """Return the look at a step, with rates over the time before it."""
        return self._look_from(max(step - self._window, 0), step)

    @cached_property
    def chains(self) -> list[dict[str, Any]]:
        """Latency of all chains."""
        return chain_rows(self._trace)

    @property
    def _window(self) -> int:
        """Steps over which rates are measured."""
        window_s = min(WINDOW_S, _MAX_WINDOW_SHARE * self.duration_s)
        return max(1, math.ceil(window_s * LAST_STEP / self.duration_s)) if self.duration_s else 1

    def _samples(self, steps: Iterable[int]) -> Iterator[Sample]:
        """Yield the counters at ascending steps."""
        return self._counters.at(map(self._moment, steps))

    def _moment(self, step: int) -> Moment:
        passed_s = self.duration_s * step / LAST_STEP
        return Moment(self._begin_ns + round(passed_s * _NS_PER_S), passed_s)

    def _look_from(self, before: int, after: int) -> Look:
        return self._look(*self._samples((before, after)))

    def _look(self, before: Sample, after: Sample) -> Look:
        return Look(Loads(before, after), (), {}, (), self._latencies, None, None)

    def _watch(self) -> None:
        """Fill history and events, as a viewer of the running platform would have."""
        losses = Losses()
        samples = deque(self._samples([0]), maxlen=self._window + 1)
        for sample in self._samples(range(LENGTH)):
            samples.append(sample)
            self.history.append(self._look(samples[0], samples[-1]), samples[-1].time_s)
            self._note(losses.events_of(Loads(samples[-2], samples[-1])), samples[-1].time_s)
        self._note(losses.rest(self.duration_s), self.duration_s)

    def _note(self, happened: Iterable[Event], time_s: float) -> None:
        self.events += [replace(event, time_s=time_s) for event in happened]
