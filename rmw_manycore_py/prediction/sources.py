# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""Event sources: timers and external input."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import Any

from simpy import Environment, Event
from simpy.events import EventPriority

from rmw_manycore_py.prediction.draws import Blocks
from rmw_manycore_py.prediction.events import EventLog
from rmw_manycore_py.prediction.executors import Executor, Work
from rmw_manycore_py.prediction.topics import Delivery, Publisher, after
from rmw_manycore_py.trace.events import Kind

_TIMERS_BEFORE = -1_000_000  # SimPy's own events have 0 and 1; the lowest comes first


class _Due(Event):
    """A due time: comes before all that is no timer, and timers that are due together in order."""

    def __init__(
        self, env: Environment, delay_ns: float, order: int, call: Callable[[object], None]
    ) -> None:
        super().__init__(env)
        self._ok = True
        callbacks: Any = self.callbacks
        callbacks.append(call)
        env.schedule(self, EventPriority(_TIMERS_BEFORE + order), delay_ns)


@dataclass(eq=False)
class Timer:
    """A timer; its due times do not shift, and one that is late by a period skips one.

    :ivar order: among timers that are due at the same time.
    """

    env: Environment
    period_ns: float
    executor: Executor
    work: Work
    order: int

    def start(self, phase: float) -> None:
        """Have the first due time after this part of a period."""
        self._plan(phase * self.period_ns)

    def _plan(self, delay_ns: float) -> None:
        _Due(self.env, delay_ns, self.order, self._due)

    def _due(self, _: object) -> None:
        if self.work.pending:
            self.work.missed += 1
        else:
            self.work.pending = 1
            self.executor.notify(self.work)
        self._plan(self.period_ns)


@dataclass(eq=False)
class Source:
    """External input at intervals of the profile."""

    env: Environment
    intervals_ns: Blocks
    happen: Callable[[], None]

    def start(self, delay_ns: float) -> None:
        """Schedule the first event after `delay_ns`."""
        after(self.env, delay_ns, self._come)

    def _come(self, _: object) -> None:
        self.happen()
        after(self.env, self.intervals_ns.next(), self._come)


def request(executor: Executor, work: Work) -> Callable[[], None]:
    """Return the arrival of a request, or of anything else without a message."""

    def happen() -> None:
        work.pending += 1
        executor.notify(work)

    return happen


def publication(
    env: Environment, delivery: Delivery, publisher: Publisher, log: EventLog
) -> Callable[[], None]:
    """Return a publication outside of callbacks."""

    def happen() -> None:
        message = publisher.new_message(env.now, None, env.now)
        log.add(env.now, Kind.PUBLISH_BEGIN, publisher.endpoint, value=message.size_bytes)
        delivery.deliver(message, log)

    return happen
