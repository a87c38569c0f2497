# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""A simulation whose callbacks run in real nodes, in virtual time.

The nodes decide what happens, in which order; CPUs, network and receive threads of the simulation
when. `python -m rmw_manycore_py.prediction.live` answers the timekeeper of a run.
"""

from __future__ import annotations

import sys
from collections import defaultdict
from collections.abc import Callable
from functools import partial
from pathlib import Path
from typing import IO

from rmw_manycore_py.errors import ManycoreError
from rmw_manycore_py.mapfile import Placement, load_mapfile, resolve
from rmw_manycore_py.prediction import sites_of
from rmw_manycore_py.prediction.application import application_of, period_of
from rmw_manycore_py.prediction.attribution import attributed
from rmw_manycore_py.prediction.cpu import Task
from rmw_manycore_py.prediction.events import EventLog
from rmw_manycore_py.prediction.executors import Work
from rmw_manycore_py.prediction.live_thread import LiveThread
from rmw_manycore_py.prediction.simulation import Simulation
from rmw_manycore_py.prediction.sources import Source, Timer
from rmw_manycore_py.prediction.target import Target
from rmw_manycore_py.prediction.target_file import target_named
from rmw_manycore_py.prediction.topics import Message, Publisher, Subscription, after
from rmw_manycore_py.profile.files import load
from rmw_manycore_py.profile.model import Callback, Profile

Passage = Callable[[Subscription, bool], None]

_ALIKE = 0.05  # of a period: a timer's, and what the profile measured


class Live(Simulation):
    """The platform of a run in virtual time."""

    def __init__(self, placement: Placement, profile: Profile, target: Target, seed: int) -> None:
        sites = sites_of(placement)
        super().__init__(application_of(attributed(profile)), sites, target, seed, False)
        self._log = EventLog.new(False)
        self._programs = {node.name: node.full_name for node in placement.nodes}
        self._placed = {name: one for one in self.processes for name in one.nodes}
        self._under_way: dict[int, int] = defaultdict(int)  # messages, by subscription
        self._noted: set[int] = set()  # subscriptions whose messages are all under way
        self._awaiting: dict[int, list[Callable[[], None]]] = defaultdict(list)
        self.passage: Passage = lambda *_: None
        self.look: Callable[[], None] = lambda: None
        self._works: dict[tuple[str, str, bool], Work] = {}
        self._own_publishers = {(one.node, one.topic): one for one in self.publishers}
        for work in self.works.values():
            callback = self.profile.callbacks[work.index]
            is_topic = callback.kind == "subscription"
            self._works[self._name_of(callback), callback.trigger, is_topic] = work
            if work.subscription is not None:
                work.subscription.notify = partial(self._arrived, work.subscription)

    def _start(self, source: Timer | Source, delay: float) -> None:
        """Leave what happens by itself to the real nodes."""

    def _name_of(self, callback: Callback) -> str:
        return "" if callback.node is None else self.profile.nodes[callback.node].name

    # -- what threads ask for

    def thread_of(self, program: str) -> LiveThread | None:
        """Return a new thread of a program; None for a program that the profile does not have."""
        placed = self._placed.get(self._programs.get(program, ""))
        if placed is None:
            return None
        task = Task.of(self.cpus.of(placed.site), placed.site.scheduling)
        placed.threads.append((task, self._log))
        return LiveThread(self, task, placed)

    def work_of(self, node: str, trigger: str, is_topic: bool) -> Work | None:
        """Return the callback of a subscription, service or client."""
        return self._works.get((node, trigger, is_topic))

    def timer_of(self, program: str, period_ns: float) -> Work | None:
        """Return the timer of a program whose period is nearest."""
        placed = self._placed[self._programs[program]]
        found = [
            (abs(near_ns - period_ns), index)
            for index in self.timers
            if self._name_of(self.profile.callbacks[index]) in placed.nodes
            and (near_ns := period_of(self.profile.callbacks[index]))
        ]
        off_ns, index = min(found, default=(period_ns, 0))
        return self.works[index] if off_ns <= _ALIKE * period_ns else None

    def publisher_of(self, node: str, topic: str) -> Publisher | None:
        """Return a publisher of the profile."""
        return self._own_publishers.get((node, topic))

    # -- for threads

    def wake_ns(self, task: Task) -> float:
        """Return the time until a thread runs that is woken now."""
        return self._wake_ns(task)

    def reading_ns(self, work: Work, cluster: int) -> float:
        """Return the time to read the record that is next, if it is in another cluster."""
        subscription = work.subscription
        if subscription is None or not subscription.queue:
            return 0.0
        message = subscription.queue[0]
        source = message.publisher
        if source.is_transferred or source.cluster == cluster:
            return 0.0
        return self.network.transfer(self.env.now, source.cluster, cluster, message.size_bytes)

    def deliver(self, message: Message) -> None:
        """Notify the readers of a message; those of other clusters later."""
        for far in message.publisher.far.values():
            for subscription in far:
                self._under_way[subscription.endpoint] += 1
                self.note(subscription)
        self.delivery.deliver(message, self._log)

    def is_under_way(self, work: Work) -> bool:
        """Return whether what a thread is about to take has not arrived on the platform."""
        return work.subscription is not None and self._is_all_under_way(work.subscription)

    def _is_all_under_way(self, one: Subscription) -> bool:
        return not one.queue and self._under_way[one.endpoint] > 0

    def await_arrival(self, work: Work, then: Callable[[], None]) -> None:
        """Call a function when what a thread is about to take has arrived."""
        assert work.subscription is not None
        self._awaiting[work.subscription.endpoint].append(then)

    def note(self, subscription: Subscription) -> bool:
        """Report whether all messages of a subscription are under way, if that has changed."""
        is_under_way = self._is_all_under_way(subscription)
        if is_under_way == (subscription.endpoint in self._noted):
            return False
        self._noted ^= {subscription.endpoint}
        self.passage(subscription, is_under_way)
        return True

    def _arrived(self, subscription: Subscription) -> None:
        """Have threads look at once at what comes from far: what is near, its publisher writes."""
        is_far = subscription.queue[-1].publisher.cluster != subscription.cluster
        self._under_way[subscription.endpoint] -= is_far
        for then in self._awaiting.pop(subscription.endpoint, ()):
            then()
        if self.note(subscription) and is_far:
            self.look()


class Answers:
    """Answers the timekeeper, in lines.

    `ask SEAT TID STEP SUBJECT NODE ROLE PROGRAM`: what a thread does next.
    `advance NS`: the answer is `done NS SEAT TID`, when a thread is, `look NS`, when a message has
    arrived, or `none NS`: nothing happens until then.
    `resume`: that thread, or those that wait for the message, have asked, or wait.
    Before an answer: `under_way TOPIC NODE`, all messages of a subscription are, or `arrived TOPIC
    NODE`, one has.
    """

    def __init__(self, live: Live, requests: IO[str], answers: IO[str]) -> None:
        self._live = live
        self._requests = requests
        self._answers = answers
        self._threads: dict[tuple[str, str], LiveThread | None] = {}
        self._is_answered = False
        live.passage, live.look = self._passage, partial(self._pause, "look")

    def serve(self) -> None:
        """Answer until the timekeeper ends."""
        while until := self._serve_until("advance"):
            self._advance(float(until[0]))

    def _serve_until(self, request: str) -> list[str]:
        """Take what threads ask for until another request comes; return its words."""
        while (words := self._requests.readline().split()) and words[0] != request:
            self._ask(words[1:7], " ".join(words[7:]))
        return words[1:]

    def _ask(self, words: list[str], program: str) -> None:
        seat, tid, step, subject, node, role = words
        live, key = self._live, (seat, tid)
        if key not in self._threads:
            self._threads[key] = live.thread_of(program)
        thread, then = self._threads[key], partial(self._done, seat, tid)
        if thread is None:
            after(live.env, 0.0, lambda _: then())
        elif step == "wait":
            thread.wait(then)
        elif step == "woken":
            thread.woken(then)
        elif step == "timer":
            thread.begin(live.timer_of(program, float(subject)), then)
        elif step == "take":
            thread.begin(live.work_of(node, subject, role == "topic"), then)
        else:
            thread.publish(live.publisher_of(node, subject), then)

    def _done(self, seat: str, tid: str) -> None:
        """Let a thread go on: it keeps its CPU if it asks for it again."""
        self._pause("done", seat, tid)

    def _passage(self, subscription: Subscription, is_under_way: bool) -> None:
        verb = "under_way" if is_under_way else "arrived"
        self._answers.write(f"{verb} {subscription.topic} {subscription.node}\n")

    def _pause(self, verb: str, *words: str) -> None:
        """Answer; what threads do then is asked before anything else happens at this time."""
        if self._is_answered:
            self._serve_until("advance")
        self._is_answered = True
        self._answer(verb, *words)
        self._serve_until("resume")

    def _advance(self, until_ns: float) -> None:
        """Run what comes before `until_ns`: threads that are due then come before the rest."""
        env = self._live.env
        self._is_answered = False
        limit_ns = until_ns if until_ns >= 0 else sys.float_info.max
        while not self._is_answered and env.peek() < limit_ns:
            env.step()
        if not self._is_answered:
            if env.now < until_ns:
                env.run(until=until_ns)
            self._answer("none")

    def _answer(self, verb: str, *words: str) -> None:
        print(verb, int(self._live.env.now), *words, file=self._answers, flush=True)


def live_of(mapfile: Path, profile: Path, platform: str, seed: int) -> Live:
    """Return the platform of a run with a profile.

    :raises ManycoreError: also if the mapfile lacks a node of the profile.
    """
    placement = resolve(load_mapfile(mapfile), to_start=False)
    return Live(placement, load(profile), target_named(platform), seed)


def main(mapfile: str, profile: str, platform: str, seed: str) -> None:
    """Answer on standard output what standard input asks."""
    try:
        live = live_of(Path(mapfile), Path(profile), platform, int(seed))
    except ManycoreError as error:
        sys.exit(str(error))
    Answers(live, sys.stdin, sys.stdout).serve()


if __name__ == "__main__":
    main(*sys.argv[1:])
