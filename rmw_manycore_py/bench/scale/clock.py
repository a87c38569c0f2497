# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""What simulated time costs: a small message a thousand times a second to each of many nodes.

As /clock its QoS is best effort, and keeps one: a node that is late sees the newest time only.
"""

from __future__ import annotations

from dataclasses import replace

from rmw_manycore_py.bench.contenders import FAST_DDS, INSIDE, Middleware
from rmw_manycore_py.bench.idle import cpu_ns
from rmw_manycore_py.bench.question import Run
from rmw_manycore_py.bench.round_trip import in_us
from rmw_manycore_py.bench.scale.common import OWN, at_count, drawn, on_curve, spread
from rmw_manycore_py.bench.session import Session
from rmw_manycore_py.bench.summary import Goal, Result

AGE = "age of the time that a node gets, at 1 kHz"
SEEN = "times that a node gets, of 1,000"
CPU = "CPU time of all nodes per second of simulated time"
NODES = (10, 25, 50, 100)
RATE_HZ = 1000
BYTES = 16  # a header and the time
WARM_UP, TIMES = 100, 3000
PLACES = (replace(INSIDE, name="manycore in one cluster (block)"), OWN)


def measure(run: Run) -> list[Result]:
    """Return how old the time is, how much of it is seen and what it costs, over the nodes."""
    results: list[Result] = []
    for middleware in (*PLACES, FAST_DDS):
        for count in drawn(run, NODES):
            if run.wants(f"{AGE}: {middleware.name}"):
                run.note(f"{count} nodes with simulated time: {middleware.name}")
                results += _tick(run, middleware, count)
    return results


def _tick(run: Run, middleware: Middleware, nodes: int) -> list[Result]:
    times = run.iterations(TIMES)
    placed = spread(middleware, nodes + 1) if middleware.name == OWN.name else middleware
    with Session(placed, run.cpus) as session:
        sinks = [
            session.native("fan_out", party, role="sink", depth=1, best_effort=1)
            for party in range(1, nodes + 1)
        ]
        source = session.native(
            "fan_out",
            0,
            role="source",
            depth=1,
            best_effort=1,
            bytes=BYTES,
            subscribers=nodes,
            rate_hz=RATE_HZ,
            warm_up=WARM_UP,
            iterations=times,
        )
        source.wait_until_ready()  # all have found it
        pids = [*(sink.pid for sink in sinks), *session.receive_thread_pids()]
        before_ns = cpu_ns(pids)
        source.finish()
        used_ns = cpu_ns(pids) - before_ns
        found = [sink.finish()["samples_ns"] for sink in sinks]
    seconds = (WARM_UP + times) / RATE_HZ
    return [
        on_curve(question, middleware.name, nodes, "nodes", unit, samples)
        for question, unit, samples in (
            (AGE, "us", in_us([age_ns for ages_ns in found for age_ns in ages_ns])),
            (SEEN, "count", [1000 * len(ages_ns) / times for ages_ns in found]),
            (CPU, "ms/s", [used_ns / 1e6 / seconds]),
        )
    ]


_own, _spread, _fast_dds = (at_count(each.name, NODES[-1], "nodes") for each in (*PLACES, FAST_DDS))
GOALS = (
    Goal(AGE, _own, "better", 1.0, _fast_dds),
    Goal(AGE, _spread, "better", 1.0, _fast_dds),
)
PLACEMENT = "clock: its source on the first, nodes on both in turn"
