# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""Cost of a message between rclpy nodes of one process, or two, over the number of nodes."""

from __future__ import annotations

from functools import partial

from rmw_manycore_py.bench.contenders import FAST_DDS, INSIDE, Middleware
from rmw_manycore_py.bench.question import Run
from rmw_manycore_py.bench.round_trip import in_us
from rmw_manycore_py.bench.scale.common import along, at_count, followed, on_curve
from rmw_manycore_py.bench.session import Session
from rmw_manycore_py.bench.summary import Goal, Result

HOP = "from a node to the next in its process"
CPU = "CPU time of a process per message from a node to the next"
HOP_ACROSS = "from a node to one of the other process"
CPU_ACROSS = "CPU time of a process per message from the other process"
EXECUTORS = {
    "single": "SingleThreadedExecutor",
    "multi": "MultiThreadedExecutor, 16 threads",
    "events": "EventsExecutor",
    "each": "one executor each",
}
ACROSS = ("single", "events")
NODES = (2, 10, 25, 50)
NODES_ACROSS = (2, 10, 25, 50, 100)
WARM_UP, LAPS = 2, 20


def measure(run: Run) -> list[Result]:
    """Return the time of a hop with each executor, over the nodes of a process."""
    results: list[Result] = []
    for middleware in (INSIDE, FAST_DDS):
        for executor in EXECUTORS:
            contender = f"{HOP}: {_curve(middleware, executor)}"
            measured = partial(_go_round, run, middleware, executor)
            results += along(run, contender, NODES, "nodes", measured)
        for executor in ACROSS:
            contender = f"{HOP_ACROSS}: {_curve(middleware, executor)}"
            measured = partial(_go_across, run, middleware, executor)
            places = followed(middleware, NODES_ACROSS, NODES[-1])
            results += along(run, contender, places, "nodes", measured)
    return results


def _go_round(run: Run, middleware: Middleware, executor: str, nodes: int) -> list[Result]:
    with Session(middleware, run.cpus) as session:
        laps = run.iterations(LAPS)
        found = session.python("ring", 0, executor, nodes, WARM_UP, laps).finish()
    curve = _curve(middleware, executor)
    return [
        on_curve(HOP, curve, nodes, "nodes", "us", in_us(found["samples_ns"])),
        on_curve(CPU, curve, nodes, "nodes", "us", in_us([found["cpu_ns"]])),
    ]


def _go_across(run: Run, middleware: Middleware, executor: str, nodes: int) -> list[Result]:
    """Measure two processes with so many nodes each, every message from the other one."""
    processes = 2
    laps = run.iterations(LAPS)
    with Session(middleware, run.cpus) as session:
        ring = ("ring", executor, processes * nodes, WARM_UP, laps, processes)
        first, _ = (session.python(ring[0], i, *ring[1:], i) for i in range(processes))
        found = first.finish()
    curve = _curve(middleware, executor)
    return [
        on_curve(HOP_ACROSS, curve, nodes, "nodes", "us", in_us(found["samples_ns"])),
        on_curve(CPU_ACROSS, curve, nodes, "nodes", "us", in_us([found["cpu_ns"]])),
    ]


def _curve(middleware: Middleware, executor: str) -> str:
    return f"{middleware.name}, {EXECUTORS[executor]}"


GOALS = tuple(
    Goal(
        question,
        at_count(_curve(INSIDE, executor), NODES[-1], "nodes"),
        "better",
        1.0,
        at_count(_curve(FAST_DDS, executor), NODES[-1], "nodes"),
    )
    for question, executors in ((CPU, EXECUTORS), (CPU_ACROSS, ACROSS))
    for executor in executors
)
PLACEMENT = "composed: the process on the first, a second one on the second"
