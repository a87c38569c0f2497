# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""Mutual cost of hundreds of nodes, each a process with parameter services."""

from __future__ import annotations

import os
import signal
import threading
import time
from collections.abc import Callable, Iterator, Sequence
from contextlib import contextmanager
from functools import partial

from rmw_manycore_py._transport import Platform
from rmw_manycore_py.bench.contenders import FAST_DDS, Middleware
from rmw_manycore_py.bench.idle import cpu_ns, wait_until_quiet, wake_ups
from rmw_manycore_py.bench.question import Run
from rmw_manycore_py.bench.round_trip import WARM_UP, in_us
from rmw_manycore_py.bench.scale.common import CLUSTERS, OWN, along, at_count, on_curve, spread
from rmw_manycore_py.bench.session import TIMEOUT_S, Process, Session
from rmw_manycore_py.bench.summary import Goal, Result
from rmw_manycore_py.errors import ManycoreError

UP = "starting all nodes, until each topic has its subscription"
CREATE = "creating one more node"
WOKEN = "sleeps of all others per node that joins"
REAPERS = "CPU time of the receive threads per node that joins"
IDLE = "CPU time of all when nothing happens"
ROUND_TRIP = "round trip of 64 B beside them"
GRAPH = "reading all nodes and endpoints of the graph"
READ = ", its graph read over and over"
RECLAIM = "until nothing is left of those killed at once"

NODES = (30, 60, 125, 250, 500)
# Fast DDS processes discover each other pairwise: more would take minutes.
MOST_NODES_OF_FAST_DDS = 60
KILLED = 0.4  # fraction of the nodes
JOINS = 5
READS = 20
ROUND_TRIPS = 1000
WINDOW_S = 5.0


def measure(run: Run) -> list[Result]:
    """Return the cost of starting, joining, waiting, reading and killing, over the nodes."""
    results: list[Result] = []
    for middleware in (OWN, FAST_DDS):
        most = NODES[-1] if middleware.is_manycore else MOST_NODES_OF_FAST_DDS
        counts = (count for count in NODES if count <= most)
        measured = partial(_in_clusters, run, middleware)
        results += along(run, f"{UP}: {middleware.name}", counts, "nodes", measured)
    return results


def _in_clusters(run: Run, middleware: Middleware, count: int) -> list[Result]:
    return _watch(run, spread(middleware, count), count)


def _watch(run: Run, middleware: Middleware, count: int) -> list[Result]:
    def found(question: str, unit: str, samples: Sequence[float]) -> Result:
        return on_curve(question, middleware.name, count, "nodes", unit, samples)

    with Session(middleware, run.cpus) as session:
        start = time.monotonic()
        nodes = [
            session.native("fleet", party, first=party, nodes=1, all=count, period_ms=0)
            for party in range(count)
        ]
        for node in nodes:
            node.wait_until_ready()
        results = [found(UP, "s", [time.monotonic() - start])]
        pids = [node.pid for node in nodes]
        wait_until_quiet(pids)
        joins = [_join(session, pids, count + i) for i in range(JOINS)]
        results += [
            found(CREATE, "ms", [create_ms for create_ms, _, _ in joins]),
            found(WOKEN, "count", [woken for _, woken, _ in joins]),
            found(IDLE, "ms/s", [_idle_ms(session, pids, WINDOW_S * max(run.share, 0.2))]),
            found(ROUND_TRIP, "us", _round_trips_us(run, session)),
        ]
        if middleware.is_manycore:
            with Platform(session.platform) as platform:
                with _reading(platform, run.cpus[1]):
                    beside = [_join(session, pids, count + i)[0] for i in range(JOINS)]
                results += [
                    on_curve(CREATE, f"{middleware.name}{READ}", count, "nodes", "ms", beside),
                    found(GRAPH, "ms", [_read_ms(platform) for _ in range(READS)]),
                    found(REAPERS, "us", [reapers_us for _, _, reapers_us in joins]),
                    found(RECLAIM, "ms", [_reclaim_ms(platform, nodes)]),
                ]
    return results


def _join(session: Session, others: Sequence[int], number: int) -> tuple[float, float, float]:
    """Return a node's milliseconds to create, sleeps of others, receive threads' microseconds."""
    receive_threads = session.receive_thread_pids()
    before, before_ns = wake_ups(others), cpu_ns(receive_threads)
    node = session.native("fleet", 0, first=number, nodes=1, all=0, period_ms=0)
    node.wait_until_ready()
    wait_until_quiet(receive_threads)
    woken, used_ns = wake_ups(others) - before, cpu_ns(receive_threads) - before_ns
    node.release()
    return node.finish()["samples_ns"][0] / 1e6, woken, used_ns / 1e3


@contextmanager
def _reading(platform: Platform, cpu: int) -> Iterator[None]:
    """Read the graph continuously, on a CPU other than that of joining nodes."""
    is_over = threading.Event()

    def read() -> None:
        os.sched_setaffinity(0, [cpu])  # this thread only
        while not is_over.is_set():
            platform.nodes()
            platform.endpoints()

    reader = threading.Thread(target=read)
    reader.start()
    try:
        yield
    finally:
        is_over.set()
        reader.join()


def _idle_ms(session: Session, nodes: Sequence[int], window_s: float) -> float:
    pids = [*nodes, *session.receive_thread_pids()]
    wait_until_quiet(pids)
    before = cpu_ns(pids)
    time.sleep(window_s)
    return (cpu_ns(pids) - before) / 1e6 / window_s


def _round_trips_us(run: Run, session: Session) -> list[float]:
    ping = session.native(
        "round_trip",
        0,
        role="ping",
        bytes=64,
        warm_up=WARM_UP,
        iterations=run.iterations(ROUND_TRIPS),
    )
    # In the same cluster, on the other CPU.
    pong = session.native("round_trip", CLUSTERS, role="pong")
    samples = in_us(ping.finish()["samples_ns"])
    pong.finish()
    return samples


def _read_ms(platform: Platform) -> float:
    return _ms_of(lambda: (platform.nodes(), platform.endpoints()))


def _reclaim_ms(platform: Platform, nodes: Sequence[Process]) -> float:
    victims = nodes[: int(len(nodes) * KILLED)]
    left = len(nodes) - len(victims)

    def kill() -> None:
        for victim in victims:
            os.kill(victim.pid, signal.SIGKILL)
        deadline = time.monotonic() + TIMEOUT_S
        while len(platform.processes()) > left or len(platform.nodes()) > left:
            if time.monotonic() > deadline:
                raise ManycoreError("killed nodes stay in the registry")
            time.sleep(0.005)

    return _ms_of(kill)


def _ms_of(action: Callable[[], object]) -> float:
    start = time.monotonic_ns()
    action()
    return (time.monotonic_ns() - start) / 1e6


_most, _least = (at_count(OWN.name, count, "nodes") for count in (NODES[-1], NODES[0]))
GOALS = (
    Goal(UP, _most, "within", 20),
    Goal(CREATE, at_count(f"{OWN.name}{READ}", NODES[-1], "nodes"), "within", 1.2, _most),
    Goal(WOKEN, _most, "within", 0),
    Goal(IDLE, _most, "within", 0),
    Goal(ROUND_TRIP, _most, "within", 1.1, _least),
    Goal(RECLAIM, _most, "within", 1000),
)
PLACEMENT = f"nodes: on both in turn, over {CLUSTERS} clusters"
