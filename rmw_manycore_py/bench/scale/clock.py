# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""Cost of simulated time: a small message at 1 kHz to each of many nodes.

QoS as /clock: best effort, depth 1; a late node only receives the newest time. The source is on the
platform, or a simulator outside, whose messages the bridge carries to the nodes.
"""

from __future__ import annotations

import time
from contextlib import ExitStack
from dataclasses import replace
from functools import partial

from rmw_manycore_py.bench.bridging import bridge_command
from rmw_manycore_py.bench.contenders import FAST_DDS, INSIDE, Middleware
from rmw_manycore_py.bench.idle import cpu_ns
from rmw_manycore_py.bench.question import Run
from rmw_manycore_py.bench.round_trip import in_us
from rmw_manycore_py.bench.scale.common import OWN, along, at_count, followed, on_curve, spread
from rmw_manycore_py.bench.session import TIMEOUT_S, Process, Session
from rmw_manycore_py.bench.summary import Goal, Result
from rmw_manycore_py.errors import ManycoreError
from rmw_manycore_py.native._transport import Platform
from rmw_manycore_py.routes.route import Route

AGE = "age of the time that a node gets, at 1 kHz"
SEEN = "times that a node gets, of 1,000"
CPU = "CPU time of all nodes per second of simulated time"
NODES = (10, 25, 50, 100)
# Its source does not find 100 nodes within its time.
MAX_NODES_OF_FAST_DDS = 50
RATE_HZ = 1000
BYTES = 16  # header and time
WARM_UP, TIMES = 100, 3000
TOPIC, TYPE = "/data", "std_msgs/msg/UInt8MultiArray"  # of the program fan_out
ONE = replace(INSIDE, name="manycore in one cluster (block)")
BRIDGED = replace(OWN, name=f"Fast DDS, bridge, {OWN.name}")


def measure(run: Run) -> list[Result]:
    """Return age, coverage and cost of simulated time, over the nodes."""
    results: list[Result] = []
    for middleware in (ONE, OWN, BRIDGED, FAST_DDS):
        counts = followed(middleware, NODES, MAX_NODES_OF_FAST_DDS)
        measured = partial(_tick, run, middleware)
        results += along(run, f"{AGE}: {middleware.name}", counts, "nodes", measured)
    return results


def _tick(run: Run, middleware: Middleware, nodes: int) -> list[Result]:
    times = run.iterations(TIMES)
    with ExitStack() as stack:
        inside = stack.enter_context(Session(placed(middleware, nodes), run.cpus))
        sinks = [
            inside.native("fan_out", party, role="sink", depth=1, best_effort=1)
            for party in range(1, nodes + 1)
        ]
        heard_by = [sink.pid for sink in sinks]
        if middleware is BRIDGED:
            outside = stack.enter_context(Session(FAST_DDS, run.cpus))
            heard_by.append(bridge_inward(inside, outside, TOPIC, TYPE).pid)
            source = _source(outside, 1, times)
            wait_until_heard(inside, TOPIC, nodes)
        else:
            source = _source(inside, nodes, times)
        pids = [*heard_by, *inside.receive_thread_pids()]
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


def placed(middleware: Middleware, nodes: int) -> Middleware:
    """Distribute the source and its nodes over the clusters, if the curve is about several."""
    return spread(middleware, nodes + 1) if middleware in (OWN, BRIDGED) else middleware


def _source(session: Session, subscribers: int, times: int) -> Process:
    source = session.native(
        "fan_out",
        0,
        role="source",
        depth=1,
        best_effort=1,
        bytes=BYTES,
        subscribers=subscribers,
        rate_hz=RATE_HZ,
        warm_up=WARM_UP,
        iterations=times,
    )
    source.wait_until_ready()  # all have found it
    return source


def bridge_inward(inside: Session, outside: Session, topic: str, type_name: str) -> Process:
    """Start an inward bridge process, on the CPU of the source."""
    route = Route("topic", "inward", topic, topic, type_name, outside.domain)
    return outside.start(bridge_command(inside, [route], "inward"), 0)


def wait_until_heard(session: Session, topic: str, nodes: int) -> None:
    """Return once the bridge's publisher has found all nodes."""
    deadline = time.monotonic() + TIMEOUT_S
    with Platform(session.platform) as platform:
        while time.monotonic() < deadline:
            endpoints = [e for e in platform.endpoints() if e.topic == topic]
            if any(e.kind == "publisher" and e.matched >= nodes for e in endpoints):
                return
            time.sleep(0.05)
    raise ManycoreError("the nodes and the bridge do not find each other")


_one, _spread, _bridged = (at_count(each.name, NODES[-1], "nodes") for each in (ONE, OWN, BRIDGED))
_fast_dds = at_count(FAST_DDS.name, MAX_NODES_OF_FAST_DDS, "nodes")
GOALS = (
    Goal(AGE, _one, "better", 1.0, _fast_dds),
    Goal(AGE, _spread, "better", 1.0, _fast_dds),
    Goal(AGE, _bridged, "better", 1.0, _fast_dds),
)
PLACEMENT = "clock: its source on the first, and the bridge, nodes on both in turn"
