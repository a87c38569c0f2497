# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""Cost of a message between rclpy nodes of one process, or two, over the number of nodes."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from dataclasses import dataclass
from functools import partial

from rmw_manycore_py.bench.contenders import FAST_DDS, INSIDE, Middleware
from rmw_manycore_py.bench.question import Run
from rmw_manycore_py.bench.round_trip import in_us
from rmw_manycore_py.bench.scale.common import along, at_count, followed, on_curve
from rmw_manycore_py.bench.session import Session
from rmw_manycore_py.bench.summary import Goal, Result

EXECUTORS = {
    "single": "SingleThreadedExecutor",
    "multi": "MultiThreadedExecutor, 16 threads",
    "events": "EventsExecutor",
    "each": "one executor each",
}
NODES = (2, 10, 25, 50)
WARM_UP, LAPS = 2, 20


@dataclass(frozen=True)
class Ring:
    """The nodes among which a message circulates, and what is asked about them."""

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
    for middleware in (INSIDE, FAST_DDS):
        for ring in RINGS:
            places = followed(middleware, ring.nodes, NODES[-1])
            for executor in ring.executors:
                contender = f"{ring.hop}: {_curve(middleware, executor)}"
                measured = partial(_go_round, run, ring, middleware, executor)
                results += along(run, contender, places, "nodes", measured)
    return results


def _go_round(
    run: Run, ring: Ring, middleware: Middleware, executor: str, nodes: int
) -> list[Result]:
    laps, count = run.iterations(LAPS), ring.processes * nodes
    with Session(middleware, run.cpus) as session:
        first, *_ = (
            session.python("ring", i, executor, count, WARM_UP, laps, ring.processes, i)
            for i in range(ring.processes)
        )
        found = first.finish()
    curve = _curve(middleware, executor)
    return [
        on_curve(ring.hop, curve, nodes, "nodes", "us", in_us(found["samples_ns"])),
        on_curve(ring.cpu, curve, nodes, "nodes", "us", in_us([found["cpu_ns"]])),
    ]


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
