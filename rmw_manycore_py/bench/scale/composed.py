# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""Cost of a message between rclpy nodes of one process, or two, over the number of nodes."""

from __future__ import annotations

from collections import defaultdict
from collections.abc import Iterable, Sequence
from dataclasses import dataclass
from functools import partial
from typing import Any

from rmw_manycore_py.bench.contenders import FAST_DDS, INSIDE, Middleware
from rmw_manycore_py.bench.question import Run
from rmw_manycore_py.bench.round_trip import in_us
from rmw_manycore_py.bench.scale.common import along, at_count, followed, on_curve
from rmw_manycore_py.bench.session import Session
from rmw_manycore_py.bench.summary import Goal, Result
from rmw_manycore_py.errors import ManycoreError

EXECUTORS = {
    "single": "SingleThreadedExecutor",
    "multi": "MultiThreadedExecutor, 16 threads",
    "events": "EventsExecutor",
    "each": "one executor each",
}
NODES = (2, 10, 25, 50)
WARM_UP, LAPS = 2, 10
TURNS = 3


@dataclass(frozen=True)
class Ring:
    """Nodes among which a message circulates, and the figures measured on them."""

    processes: int
    hop: str
    cpu: str
    executors: Iterable[str]
    nodes: Sequence[int]  # of each process


RINGS = (
    Ring(
        1,
        "from a node to the next in its process",
        "CPU time of a process per message from a node to the next",
        EXECUTORS,
        NODES,
    ),
    Ring(
        2,
        "from a node to one of the other process",
        "CPU time of a process per message from the other process",
        ("single", "events"),
        (*NODES, 100),
    ),
)


def measure(run: Run) -> list[Result]:
    """Return the time of a hop with each executor, over the nodes of a process."""
    results: list[Result] = []
    for ring in RINGS:
        for executor in ring.executors:
            contenders = {
                f"{ring.hop}: {_curve(middleware, executor)}": middleware
                for middleware in (INSIDE, FAST_DDS)
            }
            wanted = [name for name in contenders if run.wants(name)]
            if wanted:
                compared = [contenders[name] for name in wanted]
                measured = partial(_compare, run, ring, executor, compared)
                results += along(run, wanted[0], ring.nodes, "nodes", measured)
    return results


def _compare(
    run: Run, ring: Ring, executor: str, middlewares: list[Middleware], nodes: int
) -> list[Result]:
    """Measure the middlewares in turns; drop one that fails."""
    hops: dict[str, list[float]] = defaultdict(list)
    cpu: dict[str, list[float]] = defaultdict(list)
    for _ in range(TURNS):
        for middleware in tuple(middlewares):
            curve = _curve(middleware, executor)
            if not followed(middleware, [nodes], NODES[-1]):
                continue
            try:
                found = _go_round(run, ring, middleware, executor, nodes)
            except ManycoreError as error:
                run.failures.append(f"{ring.hop}: {at_count(curve, nodes, 'nodes')}: {error}")
                middlewares.remove(middleware)
            else:
                hops[curve] += in_us(found["samples_ns"])
                cpu[curve] += in_us(found["cpu_ns"])
    return [
        on_curve(question, curve, nodes, "nodes", "us", samples)
        for question, of in ((ring.hop, hops), (ring.cpu, cpu))
        for curve, samples in of.items()
    ]


def _go_round(
    run: Run, ring: Ring, middleware: Middleware, executor: str, nodes: int
) -> dict[str, Any]:
    laps, count = run.iterations(LAPS), ring.processes * nodes
    with Session(middleware, run.cpus) as session:
        first, *_ = (
            session.python("ring", i, executor, count, WARM_UP, laps, ring.processes, i)
            for i in range(ring.processes)
        )
        return first.finish()


def _curve(middleware: Middleware, executor: str) -> str:
    return f"{middleware.name}, {EXECUTORS[executor]}"


GOALS = tuple(
    Goal(
        ring.cpu,
        at_count(_curve(INSIDE, executor), NODES[-1], "nodes"),
        "better",
        1.0,
        at_count(_curve(FAST_DDS, executor), NODES[-1], "nodes"),
    )
    for ring in RINGS
    for executor in ring.executors
)
PLACEMENT = "composed: the process on the first, a second one on the second"
