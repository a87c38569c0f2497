# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""Executors: threads that wait, and run callbacks one after the other.

As in rclcpp and rclpy, an executor collects what is ready when it has run all that it collected
before: timers first, then subscriptions, services and clients, one message of each.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, field

from simpy import Environment

from rmw_manycore_py.prediction.cpu import Task
from rmw_manycore_py.prediction.draws import Blocks
from rmw_manycore_py.prediction.events import EventLog
from rmw_manycore_py.prediction.network import Network
from rmw_manycore_py.prediction.topics import (
    Delivery,
    Message,
    Publisher,
    Subscription,
    Taken,
    after,
)
from rmw_manycore_py.prediction.work import Demand, Execution, Join
from rmw_manycore_py.trace.events import Kind


@dataclass(eq=False)
class Group:
    """A callback group whose callbacks exclude each other."""

    is_busy: bool = False


@dataclass(eq=False)
class Work:
    """A callback: what makes it ready, and what it has done.

    :ivar pending: due times of a timer, or requests, that it has not handled.
    :ivar missed: due times of a timer that passed while an earlier one was pending.
    """

    index: int
    order: int
    demand: Demand
    dispatch_ns: Blocks
    publishers: dict[int, Publisher]
    group: Group | None = None
    join: Join | None = None
    subscription: Subscription | None = None
    pending: int = 0
    missed: int = 0
    executions: int = 0
    is_listed: bool = False  # in the executor's list of what is ready

    @property
    def is_ready(self) -> bool:
        """Whether there is something to handle."""
        return bool(self.pending or (self.subscription and self.subscription.queue))

    def draw(self) -> Execution:
        """Return what the next execution does."""
        if self.join is None:
            return self.demand.next()
        if self.join.arrive(self.index):
            return self.demand.next_publishing()
        return self.demand.next_silent()


@dataclass(eq=False)
class Executor:
    """The callbacks of one executor, and its threads."""

    env: Environment
    wake: Callable[[Task], float]
    works: list[Work] = field(default_factory=list)
    idle: list[ExecutorThread] = field(default_factory=list)
    ready: list[Work] = field(default_factory=list)
    collected: list[Work] = field(default_factory=list)

    def notify(self, work: Work) -> None:
        """Note that a callback has something to handle; wake a thread that waits."""
        if not work.is_listed:
            work.is_listed = True
            self.ready.append(work)
        self.wake_one()

    def wake_one(self) -> None:
        """Wake a thread that waits, if there is one."""
        if self.idle:
            thread = self.idle.pop()
            after(self.env, self.wake(thread.task), thread.woken)

    def next_work(self) -> Work | None:
        """Return the callback to run next; None if no callback can run now."""
        for is_fresh in (False, True):
            if is_fresh:
                self.collected += sorted(self.ready, key=lambda one: one.order)
                self.ready = []
            for work in self.collected:
                if work.group is None or not work.group.is_busy:
                    self.collected.remove(work)
                    work.is_listed = False
                    if self.idle and (self.collected or self.ready):
                        self.wake_one()
                    return work
        return None

    def done(self, work: Work) -> None:
        """List a callback again that has more to handle."""
        if not work.is_listed and work.is_ready:
            work.is_listed = True
            self.ready.append(work)


@dataclass(eq=False)
class ExecutorThread:
    """A thread of an executor.

    :ivar rest_ns: CPU time after a callback, until it looks for the next one.
    """

    env: Environment
    executor: Executor
    task: Task
    log: EventLog
    cluster: int
    delivery: Delivery
    network: Network
    rest_ns: float = 0.0
    _work: Work | None = None
    _taken: Taken | None = None
    _execution: Execution = (0.0, ())
    _step: int = 0
    _done_ns: float = 0.0
    _message: Message | None = None
    _claimed_ns: float = 0.0
    _begin_ns: float = 0.0

    def woken(self, _: object) -> None:
        """Go on after a wait, as soon as a CPU is free."""
        if self.task.has_idle_cpu:
            self._after_wait()
        else:
            self.task.run(0.0, self._after_wait)

    def _after_wait(self) -> None:
        self.log.add(self.env.now, Kind.WAIT_END, number=round(self.task.used_ns), value=1)
        self._next()

    def _next(self) -> None:
        collects = self._work is not None and not self.executor.collected
        work = self._work = self.executor.next_work()
        if work is None or collects:
            self.log.add(self.env.now, Kind.WAIT_BEGIN, number=round(self.task.used_ns))
        if work is None:
            self.executor.idle.append(self)
            return
        if collects:
            self.log.add(self.env.now, Kind.WAIT_END, number=round(self.task.used_ns), value=1)
        if work.group is not None:
            work.group.is_busy = True
        self._claimed_ns = self.env.now
        self.task.run(work.dispatch_ns.next() + self._reading_ns(work), self._begin)

    def _reading_ns(self, work: Work) -> float:
        """Return the time to read a record that is in another cluster."""
        subscription = work.subscription
        if subscription is None or not subscription.queue:
            return 0.0
        message = subscription.queue[0]
        publisher = message.publisher
        if publisher.is_transferred or publisher.cluster == self.cluster:
            return 0.0
        size_bytes = message.size_bytes
        return self.network.transfer(self.env.now, publisher.cluster, self.cluster, size_bytes)

    def _begin(self) -> None:
        """Take the message, if it is one, and begin the callback."""
        work, now = self._work, self.env.now
        assert work is not None
        self._taken = None
        self._begin_ns = now
        if work.subscription is not None:
            message = work.subscription.pop()
            if message is None:
                self._end()
                return
            self._take(work.subscription, message, now)
        else:
            work.pending -= 1
        work.executions += 1
        self._execution = work.draw()
        self._step, self._done_ns = 0, 0.0
        self._advance()

    def _take(self, subscription: Subscription, message: Message, now: float) -> None:
        self._taken = taken = Taken(message, subscription, now)
        subscription.taken.append(taken)
        ids = (subscription.endpoint, message.number, message.publisher.endpoint)
        self.log.add(self._claimed_ns, Kind.CLAIM, *ids)
        self.log.add(now, Kind.RELEASE, *ids)
        message.publisher.released(message)

    def _advance(self) -> None:
        """Run up to the next publication, or to the end."""
        demand_ns, publications = self._execution
        if self._step < len(publications):
            self._run(publications[self._step][0], self._publish)
        else:
            self._run(demand_ns, self._end)

    def _run(self, until_ns: float, then: Callable[[], None]) -> None:
        more_ns = until_ns - self._done_ns
        if more_ns > 0:
            self._done_ns = until_ns
            self.task.run(more_ns, then)
        else:
            then()

    def _publish(self) -> None:
        work, now = self._work, self.env.now
        assert work is not None
        publisher = work.publishers[self._execution[1][self._step][1]]
        self._step += 1
        self._message = message = publisher.new_message(now, self._taken, self._begin_ns)
        self.log.add(now, Kind.PUBLISH_BEGIN, publisher.endpoint, value=message.size_bytes)
        self._run(self._done_ns + publisher.publish_ns, self._written)

    def _written(self) -> None:
        assert self._message is not None
        self.delivery.deliver(self._message, self.log)
        self._advance()

    def _end(self) -> None:
        work = self._work
        assert work is not None
        if self._taken is not None:
            self._taken.end_ns = self.env.now
        if work.group is not None:
            work.group.is_busy = False
        self.executor.done(work)
        if self.rest_ns:
            self.task.run(self.rest_ns, self._next)
        else:
            self._next()
