# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""Mutual cost of hundreds of nodes with parameter services."""

from __future__ import annotations

import os
import signal
import time
from collections import defaultdict
from collections.abc import Callable, Mapping, Sequence
from contextlib import nullcontext
from functools import partial

from rmw_manycore_py.bench.contenders import FAST_DDS, Middleware
from rmw_manycore_py.bench.idle import cpu_ns, wait_until_quiet, wake_ups
from rmw_manycore_py.bench.load import awake
from rmw_manycore_py.bench.question import Run
from rmw_manycore_py.bench.round_trip import WARM_UP, in_us
from rmw_manycore_py.bench.scale import fleet, graph
from rmw_manycore_py.bench.scale.common import (
    CLUSTERS,
    OWN,
    along,
    at_count,
    followed,
    on_curve,
    round_trips_us,
    spread,
)
from rmw_manycore_py.bench.scale.fleet import MAX_PROCESSES, Fleet
from rmw_manycore_py.bench.session import TIMEOUT_S, Session
from rmw_manycore_py.bench.summary import Goal, Result
from rmw_manycore_py.errors import ManycoreError
from rmw_manycore_py.native._transport import Platform

UP = "starting all nodes, until each topic has its subscription"
CREATE = "creating one more node"
WOKEN = "sleeps of all others per node that joins"
REAPERS = "CPU time of the receive threads per node that joins"
IDLE = "CPU time of all when nothing happens"
PUBLISH = "publishing on one of their topics"
ROUND_TRIP = "round trip of 64 B beside them"
GRAPH = "reading all nodes and endpoints of the graph"
LIST = "`manycore node list`, from the start of the command to its end"
RECLAIM = "until nothing is left of those killed at once"
READ = ", its graph read over and over"
LISTED = ", manycore node list over and over"
FEW = 10  # its last node has the CPU and the cluster of that of hundreds
BESIDE_FEW = f", with {FEW} nodes instead"

# Beyond 500, several of them share a process.
NODES = (30, 60, 250, 500, 1000)
PROMISED = 500
# Fast DDS processes discover each other pairwise: more would take minutes.
MAX_NODES_OF_FAST_DDS = 60
KILLED = 0.4  # fraction of the processes
JOINS = 5
READS = 20
LISTS = 5
# What a minute shows may take half as long again as in the next.
TURNS = 5
CREATED = 4
ROUND_TRIPS = 400
PUBLISHED = 100
WINDOW_S = 5.0


def measure(run: Run) -> list[Result]:
    """Return the cost of starting, joining, waiting, reading and killing, over the nodes."""
    results: list[Result] = []
    for middleware in (OWN, FAST_DDS):
        counts = followed(middleware, NODES, MAX_NODES_OF_FAST_DDS)
        measured = partial(_watch, run, spread(middleware, MAX_PROCESSES))
        results += along(run, f"{UP}: {middleware.name}", counts, "nodes", measured)
    return results


def _watch(run: Run, middleware: Middleware, count: int) -> list[Result]:
    with Session(middleware, run.cpus) as session:
        start = time.monotonic()
        nodes = fleet.start(session, count)
        up_s = time.monotonic() - start
        with nodes.required():
            return [
                _found(middleware, count, UP, "s", [up_s]),
                *_beside(run, session, nodes),
                *(
                    _read(run, session, nodes)
                    if middleware.is_manycore
                    else _creations(run, session, nodes, {})
                ),
            ]


def _found(
    middleware: Middleware,
    count: int,
    question: str,
    unit: str,
    samples: Sequence[float],
    beside: str = "",
) -> Result:
    return on_curve(question, f"{middleware.name}{beside}", count, "nodes", unit, samples)


def _beside(run: Run, session: Session, nodes: Fleet) -> list[Result]:
    """Return what joins, rest and messages cost beside the nodes."""
    found = partial(_found, session.middleware, nodes.count)
    wait_until_quiet(nodes.pids)
    joins = [_join(session, nodes) for _ in range(JOINS)]
    results = [
        found(WOKEN, "count", [woken for woken, _ in joins]),
        found(IDLE, "ms/s", [_idle_ms(session, nodes, WINDOW_S * max(run.share, 0.2))]),
        *_messages(run, session, nodes),
    ]
    if session.middleware.is_manycore:
        results.append(found(REAPERS, "us", [reapers_us for _, reapers_us in joins]))
    return results


def _read(run: Run, session: Session, nodes: Fleet) -> list[Result]:
    """Return what reading the graph costs, itself and to others, and what kills leave."""
    found = partial(_found, session.middleware, nodes.count)
    with Platform(session.platform) as platform:
        read = partial(graph.read, platform)
        list_all = partial(graph.list_nodes, session, nodes.count)
        return [
            *_creations(run, session, nodes, {READ: read, LISTED: list_all}),
            found(GRAPH, "ms", graph.times_ms(read, READS, run.cpus)),
            found(LIST, "ms", graph.times_ms(list_all, LISTS, run.cpus)),
            found(RECLAIM, "ms", [_reclaim_ms(platform, nodes)]),
        ]


def _create(session: Session, number: int) -> float:
    """Create a node in a process of its own; return the time of that in ms."""
    node = session.native("fleet", 0, first=number, nodes=1, all=0, period_ms=0)
    node.wait_until_ready()
    node.release()
    return float(node.finish()["samples_ns"][0]) / 1e6


def _creations(
    run: Run, session: Session, nodes: Fleet, others: Mapping[str, Callable[[], None]]
) -> list[Result]:
    """Create a node with nothing beside, and beside each of the others over and over, in turns."""
    found: dict[str, list[float]] = defaultdict(list)
    for _ in range(TURNS):
        for beside, action in {"": None, **others}.items():
            with graph.over_and_over(action, run.cpus[1]) if action else nullcontext():
                found[beside] += _creations_ms(run, session, nodes)
    return [
        _found(session.middleware, nodes.count, CREATE, "ms", samples, beside)
        for beside, samples in found.items()
    ]


def _creations_ms(run: Run, session: Session, nodes: Fleet) -> list[float]:
    return [_create(session, nodes.count) for _ in range(run.iterations(CREATED))]


def _join(session: Session, nodes: Fleet) -> tuple[float, float]:
    """Return what a node that joins costs: sleeps of others, receive threads' microseconds."""
    receive_threads = session.receive_thread_pids()
    before, before_ns = wake_ups(nodes.pids), cpu_ns(receive_threads)
    node = session.native("fleet", 0, first=nodes.count, nodes=1, all=0, period_ms=0)
    node.wait_until_ready()
    wait_until_quiet(receive_threads)
    woken, used_ns = wake_ups(nodes.pids) - before, cpu_ns(receive_threads) - before_ns
    node.release()
    node.finish()
    return woken, used_ns / 1e3


def _idle_ms(session: Session, nodes: Fleet, window_s: float) -> float:
    pids = [*nodes.pids, *session.receive_thread_pids()]
    wait_until_quiet(pids)
    before = cpu_ns(pids)
    time.sleep(window_s)
    return (cpu_ns(pids) - before) / 1e6 / window_s


def _messages(run: Run, session: Session, nodes: Fleet) -> list[Result]:
    """Measure messages beside the nodes, and beside a few on another platform, in turns."""
    found: dict[tuple[str, str], list[float]] = defaultdict(list)
    with Session(session.middleware, run.cpus) as other, awake(run.cpus, TIMEOUT_S):
        platforms = (("", session, nodes), (BESIDE_FEW, other, fleet.start(other, FEW)))
        for _ in range(TURNS):
            for beside, each, its_nodes in platforms:
                found[PUBLISH, beside] += _publishes_us(run, each, its_nodes)
                # In one cluster, on both CPUs.
                found[ROUND_TRIP, beside] += round_trips_us(
                    each, run.iterations(ROUND_TRIPS), pong=CLUSTERS
                )
    return [
        _found(session.middleware, nodes.count, question, "us", samples, beside)
        for (question, beside), samples in found.items()
    ]


def _publishes_us(run: Run, session: Session, nodes: Fleet) -> list[float]:
    """Publish on a topic of the first node, to which the last one subscribes."""
    speaker = session.native(
        "fleet_speaker",
        len(nodes.processes) % len(run.cpus),  # not on the CPU of the last node's process
        topic="/fleet_0_0",
        warm_up=WARM_UP,
        iterations=run.iterations(PUBLISHED),
    )
    return in_us(speaker.finish()["samples_ns"])


def _reclaim_ms(platform: Platform, nodes: Fleet) -> float:
    victims = int(len(nodes.processes) * KILLED)
    processes, left = len(nodes.processes) - victims, nodes.nodes_after(victims)

    def kill() -> None:
        for victim in nodes.pids[:victims]:
            os.kill(victim, signal.SIGKILL)
        deadline = time.monotonic() + TIMEOUT_S
        while len(platform.processes()) > processes or len(platform.nodes()) > left:
            if time.monotonic() > deadline:
                raise ManycoreError("killed nodes stay in the registry")
            time.sleep(0.005)

    return graph.ms_of(kill)


_promised, _least = (at_count(OWN.name, count, "nodes") for count in (PROMISED, NODES[0]))
_beside_few = at_count(OWN.name + BESIDE_FEW, PROMISED, "nodes")
GOALS = (
    Goal(UP, _promised, "within", 20),
    *(
        Goal(CREATE, at_count(f"{OWN.name}{beside}", PROMISED, "nodes"), "within", 1.2, _promised)
        for beside in (READ, LISTED)
    ),
    Goal(WOKEN, _promised, "within", 0),
    Goal(REAPERS, _promised, "within", 2, _least),
    Goal(IDLE, _promised, "within", 0),
    Goal(PUBLISH, _promised, "within", 1.2, _beside_few),
    Goal(ROUND_TRIP, _promised, "within", 1.1, _beside_few),
    Goal(RECLAIM, _promised, "within", 1000),
)
PLACEMENT = f"nodes: on both in turn, over {CLUSTERS} clusters"
