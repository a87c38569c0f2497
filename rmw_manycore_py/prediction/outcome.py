# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""What a simulation has come to: chains, loads, memory, losses."""

from __future__ import annotations

from collections import defaultdict
from collections.abc import Iterator, Sequence

import numpy as np

from rmw_manycore_py.prediction.chains import chain_times
from rmw_manycore_py.prediction.prediction import (
    Communication,
    CoreUse,
    CpuUse,
    LinkUse,
    Prediction,
    QueueUse,
    ReceiveThreadUse,
    TimerUse,
)
from rmw_manycore_py.prediction.simulation import Placed, Simulation
from rmw_manycore_py.prediction.topics import Subscription
from rmw_manycore_py.prediction.tracing import trace_of
from rmw_manycore_py.trace.chains import Chain


def outcome_of(
    simulation: Simulation, duration_s: float, chains: Sequence[Chain] | None, is_traced: bool
) -> Prediction:
    """Return what came of a simulation that has run."""
    return Prediction(
        target=simulation.target,
        duration_s=duration_s,
        chains=tuple(chain_times(simulation, chains)),
        cores=tuple(_cores(simulation.processes, duration_s)),
        cpus=tuple(
            CpuUse(number, cpu.used_ns / (duration_s * 1e9))
            for number, cpu in sorted(simulation.cpus.of_host.items())
        ),
        receive_threads=tuple(_receive_threads(simulation, duration_s)),
        smem_bytes=_smem_bytes(simulation),
        communications=tuple(_communications(subscriptions_of(simulation))),
        links=tuple(_links(simulation, duration_s)),
        queues=tuple(_queues(subscriptions_of(simulation))),
        overwritten=_overwritten(simulation),
        timers=tuple(_timers(simulation)),
        executions=sum(work.executions for work in simulation.works.values()),
        trace=trace_of(simulation) if is_traced else None,
    )


def subscriptions_of(simulation: Simulation) -> list[Subscription]:
    """Return the subscriptions of a simulation."""
    works = simulation.works.values()
    return [work.subscription for work in works if work.subscription is not None]


def _cores(processes: Sequence[Placed], duration_s: float) -> Iterator[CoreUse]:
    by_core: dict[tuple[int, int], list[Placed]] = defaultdict(list)
    for placed in processes:
        by_core[placed.site.core].append(placed)
    for own in (by_core[core] for core in sorted(by_core)):
        nodes = tuple(name for placed in own for name in placed.nodes)
        used_ns = sum(placed.used_ns for placed in own)
        yield CoreUse(own[0].site.core, nodes, used_ns / (duration_s * 1e9))


def _receive_threads(simulation: Simulation, duration_s: float) -> Iterator[ReceiveThreadUse]:
    for cluster, thread in sorted(simulation.receive_threads.items()):
        share = thread.task.used_ns / (duration_s * 1e9)
        yield ReceiveThreadUse(cluster, thread.received / duration_s, share)


def _smem_bytes(simulation: Simulation) -> dict[int, int]:
    """Return what nodes take when they have started, and what growing topic DSMs held at most."""
    found = {one.cluster: one.total for one in simulation.sites.memory}
    for publisher in simulation.publishers:
        if publisher.ring_bytes is None:
            found[publisher.cluster] = found.get(publisher.cluster, 0) + publisher.peak_bytes
    return found


def _communications(subscriptions: Sequence[Subscription]) -> Iterator[Communication]:
    for one in subscriptions:
        if one.taken:
            times = [(taken.callback_ns - taken.message.published_ns) / 1e3 for taken in one.taken]
            p50_us, p99_us = np.quantile(times, (0.5, 0.99)).tolist()
            ages = [(taken.callback_ns - taken.message.origin_ns) / 1e3 for taken in one.taken]
            yield Communication(
                one.node, one.topic, len(times), p50_us, p99_us, float(np.median(ages))
            )


def _links(simulation: Simulation, duration_s: float) -> Iterator[LinkUse]:
    network = simulation.network
    for link, busy_ns in sorted(network.busy_ns.items()):
        yield LinkUse(link, network.bytes[link] / duration_s, busy_ns / (duration_s * 1e9))


def _queues(subscriptions: Sequence[Subscription]) -> Iterator[QueueUse]:
    for one in subscriptions:
        if one.lost or one.longest >= one.depth > 1:
            yield QueueUse(one.node, one.topic, one.depth, one.longest, one.lost)


def _overwritten(simulation: Simulation) -> dict[str, int]:
    found: dict[str, int] = defaultdict(int)
    for publisher in simulation.publishers:
        if publisher.overwritten:
            found[publisher.topic] += publisher.overwritten
    return dict(found)


def _timers(simulation: Simulation) -> Iterator[TimerUse]:
    profile = simulation.profile
    for index, timer in simulation.timers.items():
        node = profile.callbacks[index].node
        if timer.work.missed:
            name = "" if node is None else profile.nodes[node].name
            yield TimerUse(name, timer.period_ns / 1e3, timer.work.missed)
