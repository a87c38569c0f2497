# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""Executions of callbacks, and the publications during them."""

from __future__ import annotations

from array import array
from collections import defaultdict
from dataclasses import dataclass, field

from rmw_manycore_py.profile.babeltrace import Event, ThreadId
from rmw_manycore_py.profile.entities import Entities
from rmw_manycore_py.profile.model import Coverage
from rmw_manycore_py.profile.seen import Address, CallbackSeen, PublisherSeen, Registration


def _times() -> array[int]:
    return array("q")


@dataclass
class _Published:
    """Publications of a topic: when they were, and when the first of their chain was.

    A chain begins with a publication that is not by the callback of a subscription.
    """

    times_ns: array[int] = field(default_factory=_times)
    origins_ns: array[int] = field(default_factory=_times)


@dataclass
class _Running:
    """A callback that runs on a thread.

    :ivar origin_ns: of the message that it handles, if it is known.
    """

    at: int
    callback: CallbackSeen
    begin_ns: int
    origin_ns: int | None = None
    encloses: bool = False


class Executions:
    """Follows each thread from begin to end of its callbacks."""

    def __init__(self, entities: Entities) -> None:
        self.callbacks: list[CallbackSeen] = []
        self.tids: dict[int, set[int]] = defaultdict(set)  # by pid
        self._entities = entities
        self._current: dict[Address, tuple[Registration | None, CallbackSeen]] = {}
        self._running: dict[ThreadId, list[_Running]] = defaultdict(list)
        self._published: dict[str, _Published] = defaultdict(_Published)  # by topic
        self._ended_ns: dict[Address, int] = {}  # of the last callback, by pid and tid
        self._counts = dict.fromkeys(Coverage.model_fields, 0)

    @property
    def counts(self) -> dict[str, int]:
        """Executions outside of a callback's statistics; see Coverage."""
        running = sum(map(len, self._running.values()))
        return {**self._counts, "unfinished": self._counts["unfinished"] + running}

    def begin(self, event: Event) -> None:
        """Handle the begin of a callback."""
        running = self._running[event.thread]
        if running:
            running[-1].encloses = True
        at = event.handle
        callback = self._callback((event.thread.pid, at))
        begun = _Running(at, callback, event.time_ns)
        running.append(begun)
        published = self._published.get(callback.trigger.name)
        if published and callback.trigger.kind == "subscription":
            begun.origin_ns = self._match(event, callback, published)

    def end(self, event: Event) -> None:
        """Handle the end of a callback. Those begun inside it have ended, too."""
        running = self._running[event.thread]
        at = event.handle
        if all(one.at != at for one in running):
            self._counts["begun_before"] += 1
            return
        while (one := running.pop()).at != at:
            self._counts["unfinished"] += 1
        if one.encloses:
            self._counts["enclosing"] += 1
            return
        pid, tid = event.thread
        self._ended_ns[event.thread] = event.time_ns
        self.tids[pid].add(tid)
        one.callback.tids.add(tid)
        one.callback.begins_ns.append(one.begin_ns)
        one.callback.durations_ns.append(event.time_ns - one.begin_ns)

    def publish(self, event: Event) -> None:
        """Handle a publication: it belongs to a callback that runs on the thread, if one does."""
        pid, tid = event.thread
        self.tids[pid].add(tid)
        publisher = self._entities.publisher((pid, event.handle))
        if publisher is None:
            self._counts["publications_of_unknown_publishers"] += 1
            return
        publisher.times_ns.append(event.time_ns)
        published = self._published[publisher.topic]
        published.times_ns.append(event.time_ns)
        running = self._running[event.thread]
        if not running:
            published.origins_ns.append(event.time_ns)
            publisher.outside_callbacks += 1
            self._counts["publications_outside_callbacks"] += 1
            return
        cause = self._cause(publisher, running)
        origin_ns = event.time_ns if cause.origin_ns is None else cause.origin_ns
        published.origins_ns.append(origin_ns)
        offsets_ns = cause.callback.offsets_ns.get(publisher)
        if offsets_ns is None:
            offsets_ns = cause.callback.offsets_ns[publisher] = array("q")
        offsets_ns.append(event.time_ns - cause.begin_ns)

    def _match(self, event: Event, callback: CallbackSeen, published: _Published) -> int:
        """Note how long the message of a callback was under way; return its origin.

        It is the newest one if the thread was idle when that was published, else the next one that
        the queue still holds.
        """
        times_ns = published.times_ns
        newest = len(times_ns) - 1
        is_idle = self._ended_ns.get(event.thread, 0) <= times_ns[newest]
        if is_idle or not callback.queued_ns:
            number = newest
        else:
            depth = callback.trigger.queue_depth or 1
            number = min(max(callback.next_message, newest + 1 - depth), newest)
        queued_ns = event.time_ns - times_ns[number]
        callback.next_message = number + 1
        callback.queued_ns.append(queued_ns)
        if is_idle:
            callback.dispatch_ns.append(queued_ns)
        origin_ns = published.origins_ns[number]
        callback.age_ns.append(event.time_ns - origin_ns)
        return origin_ns

    def _cause(self, publisher: PublisherSeen, running: list[_Running]) -> _Running:
        """Return the callback of the publisher's node; else, or of several, the innermost."""
        own = [one for one in running if one.callback.trigger.node is publisher.node]
        if len(own) != 1:
            self._counts["ambiguous_publications"] += 1
        return (own or running)[-1]

    def _callback(self, at: Address) -> CallbackSeen:
        registration = self._entities.registration(at)
        known = self._current.get(at)
        if known is not None and known[0] is registration:
            return known[1]
        trigger = self._entities.trigger(registration)
        callback = CallbackSeen(at[0], trigger, registration.symbol if registration else "")
        self.callbacks.append(callback)
        self._current[at] = registration, callback
        return callback
