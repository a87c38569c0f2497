# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""Event sources: timers and external input."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

from simpy import Environment

from rmw_manycore_py.prediction.draws import Blocks
from rmw_manycore_py.prediction.events import EventLog
from rmw_manycore_py.prediction.executors import Executor, Work
from rmw_manycore_py.prediction.topics import Delivery, Publisher, after
from rmw_manycore_py.trace.events import Kind


@dataclass(eq=False)
class Timer:
    """A timer; its due times do not shift, and one that is late by a period skips one."""

    env: Environment
    period_ns: float
    executor: Executor
    work: Work

    def start(self, phase: float) -> None:
        """Have the first due time after this part of a period."""
        after(self.env, phase * self.period_ns, self._due)

    def _due(self, _: object) -> None:
        if self.work.pending:
            self.work.missed += 1
        else:
            self.work.pending = 1
            self.executor.notify(self.work)
        after(self.env, self.period_ns, self._due)


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
