# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""Puts the parts of a simulation together, and runs it."""

from __future__ import annotations

import gc
from collections import defaultdict
from dataclasses import dataclass, field

import numpy as np
from simpy import Environment

from rmw_manycore_py.errors import EXIT_BAD_INPUT, ManycoreError
from rmw_manycore_py.platform.smem import DEFAULT_DEPTH
from rmw_manycore_py.platform.topology import RECEIVE_THREAD_CORE, Core
from rmw_manycore_py.prediction.application import Application, ExecutorPlan, period_of
from rmw_manycore_py.prediction.attribution import heard_shares, rates_of_topics
from rmw_manycore_py.prediction.cpu import Task
from rmw_manycore_py.prediction.draws import Blocks, Quantiles, samples
from rmw_manycore_py.prediction.events import EventLog
from rmw_manycore_py.prediction.executors import Executor, ExecutorThread, Group, Work
from rmw_manycore_py.prediction.network import Network
from rmw_manycore_py.prediction.sites import Site, Sites
from rmw_manycore_py.prediction.sources import Source, Timer, publication, request
from rmw_manycore_py.prediction.target import Target
from rmw_manycore_py.prediction.target_cpus import TargetCpus
from rmw_manycore_py.prediction.topics import (
    Delivery,
    Publisher,
    ReceiveThread,
    Subscription,
    after,
)
from rmw_manycore_py.prediction.work import Demand, joins_of
from rmw_manycore_py.process.scheduling import Scheduling
from rmw_manycore_py.profile.model import Callback, Distribution
from rmw_manycore_py.trace.events import Kind

_SAMPLE_NS = 100e6
_FEW = 0.02  # up to this share, publications outside of callbacks belong to start-up
_BURST = 0.1  # median-to-mean ratio of intervals below which a source is bursty
_SHARED_SITE = Site(Core(1, 1))


@dataclass(eq=False)
class Placed:
    """A process of the simulation."""

    label: str
    nodes: tuple[str, ...]
    site: Site
    rest_ns: float | None  # CPU time after each callback; None if the profile does not say
    other: EventLog  # of publications outside of callbacks
    threads: list[tuple[Task, EventLog]] = field(default_factory=list)

    @property
    def used_ns(self) -> float:
        """CPU time of all threads."""
        return sum(task.used_ns for task, _ in self.threads)


class Simulation:
    """An application at its places on a target."""

    def __init__(
        self,
        application: Application,
        sites: Sites,
        target: Target,
        seed: int,
        is_traced: bool,
        timers_together: bool = False,
    ) -> None:
        self.env = Environment()
        self.application = application
        self.profile = application.profile
        self.sites = sites
        self.target = target
        self._seed = seed
        self._is_traced = is_traced
        self._timers_together = timers_together
        self._points = np.array(self.profile.quantile_shares)
        self.cpus = TargetCpus(self.env, target, sites)
        self.network = Network(target)
        self.receive_threads: dict[int, ReceiveThread] = {}
        self.delivery = Delivery(self.env, self.network, self.receive_threads)
        self.processes = self._processes()
        self._places = {name: order for order, name in enumerate(sites.nodes)}
        self.publishers = self._publishers()
        self.all_publishers = list(self.publishers)  # with those outside of the profile
        self.works: dict[int, Work] = {}
        self.timers: dict[int, Timer] = {}
        self._joins = joins_of(self.profile)
        self._rates = rates_of_topics(self.profile)
        self._groups: dict[int, Group] = defaultdict(Group)
        for plan in sorted(application.executors, key=self._order_in_mapfile):
            self._add_executor(plan)
        self._connect()
        if is_traced:
            self._sample(None)
        self._add_outside_publications()

    def random(self, *keys: int) -> np.random.Generator:
        """Return the random numbers of one part; they do not depend on other parts."""
        return np.random.default_rng([self._seed, *keys])

    def run(self, duration_s: float) -> None:
        """Run for `duration_s`, without garbage collection: all messages stay referenced."""
        was_enabled = gc.isenabled()
        gc.disable()
        try:
            self.env.run(until=duration_s * 1e9)
        finally:
            if was_enabled:
                gc.enable()

    def _start(self, source: Timer | Source, delay: float) -> None:
        """Start a timer or a source of external input.

        :param delay: in ns; of a timer: in periods.
        """
        source.start(delay)

    def _sample(self, _: object) -> None:
        """Record CPU time and held messages, as the tracer does from time to time."""
        now = self.env.now
        held: dict[int, int] = {one.cluster: one.total for one in self.sites.memory}
        for publisher in self.publishers:
            if publisher.ring_bytes is None:
                cluster = publisher.cluster
                held[cluster] = held.get(cluster, 0) + publisher.held_bytes
        for placed in self.processes:
            if not now:
                placed.other.add(now, Kind.JOIN)
            cluster = placed.site.core.cluster
            placed.other.add(now, Kind.CPU, value=round(placed.used_ns))
            placed.other.add(now, Kind.SMEM, number=cluster, value=held.get(cluster, 0))
        for thread in self.receive_threads.values():
            thread.log.add(now, Kind.CPU, value=round(thread.task.used_ns))
        after(self.env, _SAMPLE_NS, self._sample)

    # -- CPUs and processes

    def _wake_ns(self, task: Task) -> float:
        return self.target.ns("wake_us" if task.has_idle_cpu else "wake_busy_us")

    def _processes(self) -> list[Placed]:
        found = []
        for plan in self.application.processes:
            names = tuple(self.profile.nodes[index].name for index in plan.nodes)
            known = [site for name in names if (site := self.sites.of(name)) is not None]
            site = known[0] if known else _SHARED_SITE
            if not known and self.target.cpus not in ("shared", "own"):
                raise ManycoreError(
                    f"the mapfile does not place {names[0]}, which is in the profile: use the "
                    "profile of this application (manycore profile record MAPFILE)",
                    EXIT_BAD_INPUT,
                )
            rest_ns = None if plan.rest_ns is None else plan.rest_ns / self.target.speed
            log = EventLog.new(self._is_traced)
            found.append(Placed(plan.label, names, site, rest_ns, log))
        return found

    def _process_of_node(self) -> dict[int, Placed]:
        plans = self.application.processes
        return {
            node: placed
            for plan, placed in zip(plans, self.processes, strict=True)
            for node in plan.nodes
        }

    # -- topics

    def _publishers(self) -> list[Publisher]:
        placed = self._process_of_node()
        found = []
        for index, one in enumerate(self.profile.publishers):
            node = None if one.node is None else self.profile.nodes[one.node].name
            cluster = 1 if one.node is None else placed[one.node].site.core.cluster
            publish_ns = one.publish_ns.mean / self.target.speed if one.publish_ns else None
            found.append(
                Publisher(
                    endpoint=index,
                    topic=one.topic,
                    node=node or "",
                    cluster=cluster,
                    publish_ns=self.target.ns("publish_us") if publish_ns is None else publish_ns,
                    sizes=self._blocks(one.size_bytes, 2, index),
                    ring_bytes=self.sites.rings.get(one.topic),
                    is_transferred=one.topic in self.sites.transferred,
                )
            )
        return found

    def _blocks(self, distribution: Distribution | None, *keys: int) -> Blocks | None:
        if distribution is None:
            return None
        return samples(self.random(*keys), Quantiles(self._points, distribution))

    def _subscription(self, index: int, executor: Executor, work: Work, placed: Placed) -> None:
        callback = self.profile.callbacks[index]
        node = "" if callback.node is None else self.profile.nodes[callback.node].name
        depth = self.sites.depths.get((node, callback.trigger))
        if depth is None and callback.subscription is not None:
            depth = self.profile.subscriptions[callback.subscription].queue_depth
        work.subscription = Subscription(
            endpoint=len(self.publishers) + index,
            topic=callback.trigger,
            node=node,
            cluster=placed.site.core.cluster,
            depth=depth or DEFAULT_DEPTH,
            notify=lambda: executor.notify(work),
        )

    def _connect(self) -> None:
        """Tell publishers about subscriptions, and start what nothing in the profile publishes."""
        by_topic: dict[str, list[Subscription]] = defaultdict(list)
        for index, work in self.works.items():
            if work.subscription is not None and index in self.application.driven:
                by_topic[work.subscription.topic].append(work.subscription)
        for publisher in self.publishers:
            self._match(publisher, by_topic[publisher.topic])
        outside: dict[str, list[int]] = defaultdict(list)
        for index, work in self.works.items():
            if work.subscription is not None and index not in self.application.driven:
                outside[work.subscription.topic].append(index)
        for topic, indices in outside.items():
            self._add_topic_from_outside(topic, indices)

    def _match(self, publisher: Publisher, subscriptions: list[Subscription]) -> None:
        for one in subscriptions:
            if one.cluster == publisher.cluster:
                publisher.near.append(one)
            else:
                publisher.far.setdefault(one.cluster, []).append(one)
                self._ensure_receive_thread(one.cluster)

    def _ensure_receive_thread(self, cluster: int) -> None:
        if cluster in self.receive_threads:
            return
        core = Core(cluster, RECEIVE_THREAD_CORE)
        cpu = self.sites.receive_cpus.get(cluster)
        cpus = self.cpus.of(Site(core, () if cpu is None else (cpu,)))
        priority = self.sites.receive_priorities.get(cluster)
        self.receive_threads[cluster] = ReceiveThread(
            self.env,
            cluster,
            Task.of(cpus, Scheduling("fifo", priority) if priority else None),
            *self._receive_ns(),
            self._wake_ns,
            EventLog.new(self._is_traced),
        )

    def _receive_ns(self) -> tuple[float, float]:
        """Return the CPU time of a receive thread per message, before and after it notifies."""
        before_ns = self.target.ns("receive_us")
        after_ns = max((self.profile.receive_ns or 0.0) - before_ns, 0.0)
        return before_ns / self.target.speed, after_ns / self.target.speed

    def _add_topic_from_outside(self, topic: str, indices: list[int]) -> None:
        callback = self.profile.callbacks[indices[0]]
        intervals = self._intervals(callback, 3, indices[0])
        subscriptions = [self.works[index].subscription for index in indices]
        known = [one for one in subscriptions if one is not None]
        publisher = Publisher(
            len(self.publishers) + len(self.profile.callbacks) + indices[0],
            *(topic, "", known[0].cluster, 0.0, None, None),
        )
        self.all_publishers.append(publisher)
        self._match(publisher, known)
        happen = publication(self.env, self.delivery, publisher, EventLog.new(False))
        source = Source(self.env, intervals, happen)
        self._start(source, self._phase_ns(callback, 4, indices[0]))

    def _intervals(self, callback: Callback, *keys: int) -> Blocks:
        return self._at_rate(callback.interval_ns, callback.rate_hz or 1.0, *keys)

    def _phase_ns(self, callback: Callback, *keys: int) -> float:
        return float(self.random(*keys).random()) * 1e9 / (callback.rate_hz or 1.0)

    def _at_rate(self, intervals_ns: Distribution | None, rate_hz: float, *keys: int) -> Blocks:
        """Return intervals with the mean of a rate; a burst is spread over the run."""
        mean_ns = 1e9 / rate_hz
        if intervals_ns is None:
            return Blocks(lambda count: np.full(count, mean_ns))
        random, quantiles = self.random(*keys), Quantiles(self._points, intervals_ns)
        if quantiles.median < _BURST * mean_ns:
            return Blocks(lambda count: random.exponential(mean_ns, count))
        scale = mean_ns / quantiles.mean
        return Blocks(lambda count: quantiles.at(random.random(count)) * scale)

    def _add_outside_publications(self) -> None:
        placed = self._process_of_node()
        span_ns = self.profile.duration_ns
        heard = heard_shares(self.profile)
        for index, one in enumerate(self.profile.publishers):
            few = _FEW * (one.publications or 0)
            if not span_ns or not one.outside_callbacks or one.outside_callbacks <= few:
                continue
            rate_hz = one.outside_callbacks * 1e9 / span_ns * heard.get(one.topic, 1.0)
            log = EventLog.new(False) if one.node is None else placed[one.node].other
            happen = publication(self.env, self.delivery, self.publishers[index], log)
            source = Source(self.env, self._at_rate(one.interval_ns, rate_hz, 5, index), happen)
            self._start(source, self.random(11, index).random() * 1e9 / rate_hz)

    # -- executors

    def _order_in_mapfile(self, plan: ExecutorPlan) -> int:
        nodes = self.processes[plan.process].nodes
        return min(self._places.get(name, len(self._places)) for name in nodes)

    def _add_executor(self, plan: ExecutorPlan) -> None:
        placed = self.processes[plan.process]
        executor = Executor(self.env, self._wake_ns)
        for order, index in enumerate(plan.callbacks):
            self._add_work(index, order, executor, placed)
        for _ in range(plan.threads):
            task = Task.of(self.cpus.of(placed.site), placed.site.scheduling)
            log = EventLog.new(self._is_traced)
            log.add(self.env.now, Kind.WAIT_BEGIN)
            placed.threads.append((task, log))
            thread = ExecutorThread(
                self.env,
                executor,
                task,
                log,
                placed.site.core.cluster,
                self.delivery,
                self.network,
                placed.rest_ns or 0.0,
            )
            executor.idle.append(thread)

    def _add_work(self, index: int, order: int, executor: Executor, placed: Placed) -> None:
        callback = self.profile.callbacks[index]
        group = self.application.groups.get(index)
        work = Work(
            index,
            order,
            Demand(
                self.profile,
                callback,
                self.random(6, index),
                self.target.speed,
                self._shares_of(callback),
            ),
            self._dispatch(callback, index, is_in_rest=placed.rest_ns is not None),
            {one.publisher: self.publishers[one.publisher] for one in callback.publishes},
            None if group is None else self._groups[group],
            self._joins.get(index),
        )
        self.works[index] = work
        executor.works.append(work)
        if callback.kind == "subscription":
            self._subscription(index, executor, work, placed)
        elif callback.kind == "timer" and (period_ns := period_of(callback)):
            timer = Timer(self.env, period_ns, executor, work, order=len(self.timers))
            self.timers[index] = timer
            phase = 1.0 if self._timers_together else self.random(7, index).random()
            self._start(timer, phase)
        else:
            source = Source(self.env, self._intervals(callback, 8, index), request(executor, work))
            self._start(source, self._phase_ns(callback, 9, index))

    def _shares_of(self, callback: Callback) -> dict[int, float]:
        """Return publications per execution, where the profile has rates only."""
        found: dict[int, float] = {}
        for output in callback.publishes:
            rate_hz = self._rates.get(self.profile.publishers[output.publisher].topic)
            if output.count is None and rate_hz and callback.rate_hz:
                found[output.publisher] = min(rate_hz / callback.rate_hz, 1.0)
        return found

    def _dispatch(self, callback: Callback, index: int, *, is_in_rest: bool) -> Blocks:
        found = self._blocks(callback.dispatch_ns, 10, index)
        speed = self.target.speed
        if found is not None:
            values = found
            return Blocks(lambda count: np.array([values.next() for _ in range(count)]) / speed)
        default_ns = 0.0 if is_in_rest else self.target.ns("dispatch_us") / speed
        return Blocks(lambda count: np.full(count, default_ns))
