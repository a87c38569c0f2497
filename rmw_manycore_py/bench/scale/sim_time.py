# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""Cost of simulated time for rclpy nodes with `use_sim_time`: /clock at 1 kHz, all in Python."""

from __future__ import annotations

from contextlib import ExitStack
from functools import partial

from rmw_manycore_py.bench.contenders import FAST_DDS, Middleware
from rmw_manycore_py.bench.idle import cpu_ns
from rmw_manycore_py.bench.question import Run
from rmw_manycore_py.bench.scale.clock import (
    BRIDGED,
    ONE,
    RATE_HZ,
    TIMES,
    bridge_inward,
    placed,
    wait_until_heard,
)
from rmw_manycore_py.bench.scale.common import OWN, along, at_count, on_curve
from rmw_manycore_py.bench.session import Session
from rmw_manycore_py.bench.summary import Goal, Result

EACH = "CPU time of an rclpy node with use_sim_time per time it gets"
CPU = "CPU time of all rclpy nodes with use_sim_time per second"
SEEN = "times per second that an rclpy node with use_sim_time gets"
NODES = (5, 10)
CLOCK, TYPE = "/clock", "rosgraph_msgs/msg/Clock"


def measure(run: Run) -> list[Result]:
    """Return cost and received rate of simulated time, over the nodes."""
    results: list[Result] = []
    for middleware in (ONE, OWN, BRIDGED, FAST_DDS):
        measured = partial(_tick, run, middleware)
        results += along(run, f"{EACH}: {middleware.name}", NODES, "nodes", measured)
    return results


def _tick(run: Run, middleware: Middleware, count: int) -> list[Result]:
    times = run.iterations(TIMES)
    with ExitStack() as stack:
        session = outside = stack.enter_context(Session(placed(middleware, count), run.cpus))
        nodes = [session.python("sim_time", 1 + i, "node", i) for i in range(count)]
        for node in nodes:
            node.wait_until_ready()
        pids = [node.pid for node in nodes]
        if middleware is BRIDGED:
            outside = stack.enter_context(Session(FAST_DDS, run.cpus))
            pids.append(bridge_inward(session, outside, CLOCK, TYPE).pid)
        heard_by = 1 if middleware is BRIDGED else count
        clock = outside.python("sim_time", 0, "clock", heard_by, times, RATE_HZ)
        clock.wait_until_ready()
        if middleware is BRIDGED:
            wait_until_heard(session, CLOCK, count)
        pids += session.receive_thread_pids()
        before_ns = cpu_ns(pids)
        seconds = clock.finish()["seconds"]
        used_ns = cpu_ns(pids) - before_ns
        moves = [node.finish()["moves"] for node in nodes]
    return [
        on_curve(EACH, middleware.name, count, "nodes", "us", [used_ns / 1e3 / sum(moves)]),
        on_curve(CPU, middleware.name, count, "nodes", "ms/s", [used_ns / 1e6 / seconds]),
        on_curve(SEEN, middleware.name, count, "nodes", "1/s", [each / seconds for each in moves]),
    ]


_fast_dds = at_count(FAST_DDS.name, NODES[-1], "nodes")
# Where the CPUs are saturated, nodes that get fewer times use less of them.
GOALS = tuple(
    Goal(EACH, at_count(each.name, NODES[-1], "nodes"), "better", 1.0, _fast_dds)
    for each in (ONE, OWN)
)
PLACEMENT = "simulated time: /clock on the first, and the bridge, nodes on both in turn"
