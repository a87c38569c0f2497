# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""Messages: topic DSMs, subscriber queues, and the receive threads between clusters.

A publish notifies subscriptions of its own cluster itself. In another cluster, its receive thread
does so when the eMCOS message has come, and the subscriber reads the record across the network.
"""

from __future__ import annotations

from array import array
from collections import deque
from collections.abc import Callable
from dataclasses import dataclass, field
from typing import Any

from simpy import Environment
from simpy.events import Timeout

from rmw_manycore_py.prediction.cpu import Task
from rmw_manycore_py.prediction.draws import Blocks
from rmw_manycore_py.prediction.events import EventLog
from rmw_manycore_py.prediction.network import Network
from rmw_manycore_py.trace.events import Kind


def _floats() -> array[float]:
    return array("d")


@dataclass(eq=False, slots=True)
class Message:
    """A record in a topic DSM."""

    publisher: Publisher
    number: int
    published_ns: float
    size_bytes: int
    cause: Taken | None
    unread: int
    is_gone: bool = False

    @property
    def origin_ns(self) -> float:
        """When the first message of its chain was published."""
        message = self
        while message.cause is not None:
            message = message.cause.message
        return message.published_ns


@dataclass(eq=False, slots=True)
class Taken:
    """A message that a subscription has taken, with the begin of its callback."""

    message: Message
    subscription: Subscription
    callback_ns: float
    end_ns: float = 0.0  # 0: not yet


@dataclass(eq=False)
class Subscription:
    """A subscriber queue that overwrites its oldest entry."""

    endpoint: int
    topic: str
    node: str
    cluster: int
    depth: int
    notify: Callable[[], None]
    queue: deque[Message] = field(default_factory=deque)
    lost: int = 0
    longest: int = 0
    taken: list[Taken] = field(default_factory=list)

    def push(self, now: float, message: Message, log: EventLog) -> None:
        """Add a message and wake the node."""
        log.add(now, Kind.HINT, self.endpoint, message.number, message.publisher.endpoint)
        queue = self.queue
        if len(queue) >= self.depth:
            oldest = queue.popleft()
            oldest.publisher.released(oldest)
            self.lost += 1
            log.add(now, Kind.LOST, self.endpoint, 0, 1)
        queue.append(message)
        if len(queue) > self.longest:
            self.longest = len(queue)
        self.notify()

    def pop(self) -> Message | None:
        """Return the oldest message that its topic DSM still has."""
        while self.queue:
            message = self.queue.popleft()
            if not message.is_gone:
                return message
            self.lost += 1
        return None


@dataclass(eq=False)
class Publisher:
    """A publisher with its topic DSM.

    :ivar ring_bytes: its size; None if it grows.
    """

    endpoint: int
    topic: str
    node: str
    cluster: int
    publish_ns: float
    sizes: Blocks | None
    ring_bytes: int | None
    near: list[Subscription] = field(default_factory=list)
    far: dict[int, list[Subscription]] = field(default_factory=dict)
    is_transferred: bool = False
    number: int = 0
    held: deque[Message] = field(default_factory=deque)
    held_bytes: int = 0
    peak_bytes: int = 0
    overwritten: int = 0
    published_bytes: int = 0
    times_ns: array[float] = field(default_factory=_floats)
    begins_ns: array[float] = field(default_factory=_floats)  # of the publishing callbacks

    @property
    def readers(self) -> int:
        """Number of subscriptions."""
        return len(self.near) + sum(map(len, self.far.values()))

    def new_message(self, now: float, cause: Taken | None, begin_ns: float) -> Message:
        """Write a record; the oldest ones give way if the topic DSM is full."""
        size_bytes = int(self.sizes.next()) if self.sizes else 0
        message = Message(self, self.number, now, size_bytes, cause, self.readers)
        self.number += 1
        self.times_ns.append(now)
        self.begins_ns.append(begin_ns)
        self.published_bytes += size_bytes
        if message.unread:
            self._hold(message)
        return message

    def _hold(self, message: Message) -> None:
        self.held.append(message)
        self.held_bytes += message.size_bytes
        while self.ring_bytes is not None and self.held_bytes > self.ring_bytes:
            oldest = self.held.popleft()
            if oldest.unread:
                oldest.is_gone = True
                self.overwritten += 1
            self.held_bytes -= oldest.size_bytes
            if oldest is message:
                break
        self.peak_bytes = max(self.peak_bytes, self.held_bytes)

    def released(self, message: Message) -> None:
        """Note that a reader is done with a record; free those at the ring's end."""
        message.unread -= 1
        held = self.held
        while held and held[0].unread <= 0:
            self.held_bytes -= held.popleft().size_bytes


@dataclass(eq=False)
class ReceiveThread:
    """The receive thread of a cluster.

    :ivar receive_ns: CPU time per eMCOS message until the readers are notified.
    :ivar rest_ns: and from there until it waits again.
    """

    env: Environment
    cluster: int
    task: Task
    receive_ns: float
    rest_ns: float
    wake: Callable[[Task], float]
    log: EventLog
    queue: deque[Message] = field(default_factory=deque)
    is_awake: bool = False
    received: int = 0

    def arrive(self, message: Message) -> None:
        """Take an eMCOS message."""
        self.queue.append(message)
        if not self.is_awake:
            self.is_awake = True
            after(self.env, self.wake(self.task), self._woken)

    def _woken(self, _: object) -> None:
        self.task.run(self.receive_ns, self._receive)

    def _receive(self) -> None:
        now = self.env.now
        message = self.queue.popleft()
        self.received += 1
        publisher = message.publisher
        self.log.add(now, Kind.RECEIVE, publisher.endpoint, message.number, self.cluster)
        for subscription in publisher.far.get(self.cluster, ()):
            subscription.push(now, message, self.log)
        self.task.run(self.rest_ns, self._go_on)

    def _go_on(self) -> None:
        if self.queue:
            self.task.run(self.receive_ns, self._receive)
        else:
            self.is_awake = False


@dataclass(eq=False)
class Delivery:
    """Brings a published message to its readers."""

    env: Environment
    network: Network
    receive_threads: dict[int, ReceiveThread]

    def deliver(self, message: Message, log: EventLog) -> None:
        """Notify all readers, now or when the eMCOS message has come.

        In the order of the transport: those of the own cluster, then the other clusters by number.
        """
        publisher, now = message.publisher, self.env.now
        log.add(now, Kind.WRITE, publisher.endpoint, message.number, message.size_bytes)
        for subscription in publisher.near:
            subscription.push(now, message, log)
        for cluster in sorted(publisher.far):
            log.add(now, Kind.SEND, publisher.endpoint, message.number, cluster)
            size_bytes = message.size_bytes if publisher.is_transferred else 0
            delay_ns = self.network.send(now, publisher.cluster, cluster, size_bytes)
            thread = self.receive_threads[cluster]
            if delay_ns:
                after(self.env, delay_ns, _arrival(thread, message))
            else:
                thread.arrive(message)
        log.add(now, Kind.PUBLISH_END, publisher.endpoint, message.number)


def _arrival(thread: ReceiveThread, message: Message) -> Callable[[object], None]:
    return lambda _: thread.arrive(message)


def after(env: Environment, delay_ns: float, call: Callable[[object], None]) -> None:
    """Call a function in some time."""
    callbacks: Any = Timeout(env, delay_ns).callbacks
    callbacks.append(call)
