# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""A thread of a real node on a simulated CPU: how long it takes from one step to the next."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, field
from typing import Protocol

from simpy import Environment

from rmw_manycore_py.prediction.cpu import Task
from rmw_manycore_py.prediction.executors import Work
from rmw_manycore_py.prediction.simulation import Placed
from rmw_manycore_py.prediction.topics import Message, Publisher, Subscription, Taken, after
from rmw_manycore_py.prediction.work import Execution

Then = Callable[[], None]


class LivePlatform(Protocol):
    """What a thread needs of its platform."""

    env: Environment

    def wake_ns(self, task: Task) -> float:
        """Return the time until a thread runs that is woken now."""

    def reading_ns(self, work: Work, cluster: int) -> float:
        """Return the time to read the record that is next, if it is in another cluster."""

    def deliver(self, message: Message) -> None:
        """Notify the readers of a message."""

    def is_under_way(self, work: Work) -> bool:
        """Return whether what a thread is about to take has not arrived."""

    def await_arrival(self, work: Work, then: Then) -> None:
        """Call a function when what a thread is about to take has arrived."""

    def note(self, subscription: Subscription) -> bool:
        """Note that a subscription's queue has changed."""


@dataclass(eq=False)
class LiveThread:
    """What a thread does is real, how long it takes is drawn from the profile.

    As ExecutorThread, but whether an execution publishes is known only when it does.

    :ivar placed: its process.
    """

    live: LivePlatform
    task: Task
    placed: Placed
    _work: Work | None = None
    _taken: Taken | None = None
    _begin_ns: float = 0.0
    _done_ns: float = 0.0
    _execution: Execution | None = None  # None: not drawn yet
    _left: list[tuple[float, int]] = field(default_factory=list)  # publications to come

    def woken(self, then: Then) -> None:
        """Go on after a wait."""

        def go_on(_: object) -> None:
            if self.task.has_idle_cpu:
                then()
            else:
                self.task.run(0.0, then)

        after(self.live.env, self.live.wake_ns(self.task), go_on)

    def begin(self, work: Work | None, then: Then) -> None:
        """End the callback before; begin another one, which the profile may not have."""
        self._end(lambda: self._dispatch(work, then))

    def _dispatch(self, work: Work | None, then: Then) -> None:
        if work is None:
            self._run(0.0, then)
        elif self.live.is_under_way(work):
            self.live.await_arrival(work, lambda: self.woken(lambda: self._dispatch(work, then)))
        else:
            cluster = self.placed.site.core.cluster
            demand_ns = work.dispatch_ns.next() + self.live.reading_ns(work, cluster)
            self._run(demand_ns, lambda: self._begun(work, then))

    def _begun(self, work: Work, then: Then) -> None:
        now = self.live.env.now
        self._work, self._begin_ns, self._done_ns = work, now, 0.0
        subscription = work.subscription
        message = subscription.pop() if subscription is not None else None
        if subscription is not None and message is not None:
            self._taken = Taken(message, subscription, now)
            subscription.taken.append(self._taken)
            message.publisher.released(message)
        if subscription is not None:
            self.live.note(subscription)
        work.executions += 1
        if work.demand.always_publishes:
            self._draw(work.demand.next())
        then()

    def _draw(self, execution: Execution) -> None:
        self._execution = execution
        self._left = list(execution[1])

    def publish(self, publisher: Publisher | None, then: Then) -> None:
        """Run up to a publication."""
        if self._work is None or publisher is None:
            self._run(0.0, then)
            return
        if self._execution is None:
            self._draw(self._work.demand.next_publishing())
        planned = next((one for one in self._left if one[1] == publisher.endpoint), None)
        if planned is not None:
            self._left.remove(planned)
        until_ns = self._done_ns if planned is None else planned[0]
        self._run_until(until_ns, lambda: self._publish(publisher, then))

    def _publish(self, publisher: Publisher, then: Then) -> None:
        message = publisher.new_message(self.live.env.now, self._taken, self._begin_ns)
        until_ns = self._done_ns + publisher.publish_ns
        self._run_until(until_ns, lambda: self._written(message, then))

    def _written(self, message: Message, then: Then) -> None:
        self.live.deliver(message)
        then()

    def wait(self, then: Then) -> None:
        """End the callback, and collect ready entities."""
        self._end(then)

    def _end(self, then: Then) -> None:
        work = self._work
        if work is None:
            self._run(0.0, then)
            return
        if self._execution is None:
            self._draw(work.demand.next_silent())
        assert self._execution is not None
        self._run_until(self._execution[0], lambda: self._ended(then))

    def _ended(self, then: Then) -> None:
        if self._taken is not None:
            self._taken.end_ns = self.live.env.now
        self._work = self._taken = self._execution = None
        self._run(self.placed.rest_ns or 0.0, then)

    def _run_until(self, until_ns: float, then: Then) -> None:
        more_ns, self._done_ns = until_ns - self._done_ns, max(until_ns, self._done_ns)
        self._run(more_ns, then)

    def _run(self, demand_ns: float, then: Then) -> None:
        self.task.run(max(demand_ns, 0.0), then)
