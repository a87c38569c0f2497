# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""Round trips and throughput between external and internal rclpy nodes, and an idle bridge.

A bridged round trip takes two hops of Fast DDS and two of the platform, so it is compared with the
sum of a round trip in Fast DDS and one on the platform, of the same run.
"""

from __future__ import annotations

import time
from collections.abc import Sequence

from rmw_manycore_py.bench import images
from rmw_manycore_py.bench.bridging import bridge_command
from rmw_manycore_py.bench.contenders import BETWEEN, FAST_DDS, Middleware
from rmw_manycore_py.bench.idle import cpu_ns, wait_until_quiet
from rmw_manycore_py.bench.question import PAYLOADS, Question, Run
from rmw_manycore_py.bench.rclpy_round_trip import WARM_UP, iterations
from rmw_manycore_py.bench.round_trip import in_us
from rmw_manycore_py.bench.session import Process, Session
from rmw_manycore_py.bench.summary import Goal, Result
from rmw_manycore_py.routes.route import DIRECTIONS, Direction, Route

SIZES = ("64 B", "1 MiB")
INWARD, OUTWARD = "bridged inward", "bridged outward"
IN_FLIGHT = 8
STRETCH = 40  # messages per throughput sample
STRETCHES = 10
BRIDGED = "bridged"
SUM = "Fast DDS + platform"
IDLE = "idle bridge, CPU"
WINDOW_S = 10.0
# Parties whose CPUs the inward and the outward process share. In round trips it is that of the node
# they receive from; for throughput that of the inside node: DDS goes from CPU to CPU in either
# case.
BESIDE_SENDER, BESIDE_INSIDE = (0, 1), (1, 0)
_TYPE = "std_msgs/msg/UInt8MultiArray"


def measure(run: Run) -> list[Result]:
    """Measure all sizes, then the idle bridge, then images under load."""
    results = []
    for size in SIZES:
        results += _measure_size(run, size)
    results += _measure_throughput(run)
    if run.wants(f"{IDLE}: {BRIDGED}"):
        results.append(Result(IDLE, BRIDGED, "ms/s", (_idle_ms(run),)))
    return results + images.measure(run)


def _measure_size(run: Run, size: str) -> list[Result]:
    messages = run.iterations(iterations(PAYLOADS[size]))
    arguments = (PAYLOADS[size], WARM_UP, messages)

    def direct(middleware: Middleware) -> Sequence[float]:
        with Session(middleware, run.cpus) as session:
            return _talk(session, session, arguments)

    def bridged() -> Sequence[float]:
        with Session(BETWEEN, run.cpus) as inside, Session(FAST_DDS, run.cpus) as outside:
            _start_bridge(inside, outside)
            return _talk(outside, inside, arguments)

    question = f"bridged round trip {size}"
    results = run.interleave(
        question,
        "us",
        {
            BRIDGED: bridged,
            FAST_DDS.name: lambda: direct(FAST_DDS),
            BETWEEN.name: lambda: direct(BETWEEN),
        },
    )
    medians = {result.contender: result.summary.median for result in results}
    if FAST_DDS.name in medians and BETWEEN.name in medians:
        total = medians[FAST_DDS.name] + medians[BETWEEN.name]
        results.append(Result(question, SUM, "us", (total,)))
    return results


def _talk(asking: Session, answering: Session, arguments: Sequence[int]) -> list[float]:
    pong = answering.python("pong", 1)
    ping = asking.python("ping", 0, *arguments)
    found = ping.finish()
    pong.finish()
    return in_us(found["samples_ns"])


def _measure_throughput(run: Run) -> list[Result]:
    """Measure 1 MiB with eight messages in flight, in both directions, against Fast DDS alone."""
    lost: dict[str, list[float]] = {}

    def direct() -> Sequence[float]:
        with Session(FAST_DDS, run.cpus) as session:
            return _flood(run, session, session, ("/ping", "/pong"), lost, FAST_DDS.name)

    def bridged(name: str) -> Sequence[float]:
        with Session(BETWEEN, run.cpus) as inside, Session(FAST_DDS, run.cpus) as outside:
            _start_bridge(inside, outside, BESIDE_INSIDE)
            if name == INWARD:
                return _flood(run, outside, inside, ("/ping", "/pong"), lost, name)
            return _flood(run, inside, outside, ("/pong", "/ping"), lost, name)

    question = "bridged throughput 1 MiB"
    rates = run.interleave(
        question,
        "1/s",
        {
            INWARD: lambda: bridged(INWARD),
            OUTWARD: lambda: bridged(OUTWARD),
            FAST_DDS.name: direct,
        },
        higher_is_better=True,
    )
    return rates + [
        Result(f"{question}, lost", name, "messages", tuple(counts))
        for name, counts in lost.items()
    ]


def _flood(
    run: Run,
    sending: Session,
    hearing: Session,
    topics: tuple[str, str],
    lost: dict[str, list[float]],
    name: str,
) -> list[float]:
    sink = hearing.python("sink", 1, *topics, IN_FLIGHT)
    stretch, stretches = run.iterations(STRETCH), run.iterations(STRETCHES)
    sizes = (PAYLOADS["1 MiB"], IN_FLIGHT, stretch, stretch, stretches)
    found = sending.python("source", 0, *topics, *sizes).finish()
    lost.setdefault(name, []).append(sink.finish()["lost"])
    return [stretch / sample_ns * 1e9 for sample_ns in found["samples_ns"]]


def _start_bridge(
    inside: Session, outside: Session, parties: tuple[int, int] = BESIDE_SENDER
) -> list[Process]:
    """Start both processes, each on the CPU of a party."""
    ways: tuple[tuple[str, Direction], ...] = (("/ping", "inward"), ("/pong", "outward"))
    routes = [Route("topic", way, name, name, _TYPE, outside.domain) for name, way in ways]
    return [
        outside.start(bridge_command(inside, routes, way, core), party)
        for core, (party, way) in enumerate(zip(parties, DIRECTIONS, strict=True), 2)
    ]


def _idle_ms(run: Run) -> float:
    """Return the CPU time of both processes in ms per second, with one node on each side."""
    window_s = WINDOW_S * max(run.share, 0.1)
    with Session(BETWEEN, run.cpus) as inside, Session(FAST_DDS, run.cpus) as outside:
        pids = [process.pid for process in _start_bridge(inside, outside)]
        inside.python("pong", 1)
        outside.python("pong", 0)
        time.sleep(2)  # wait for DDS discovery traffic to end
        wait_until_quiet(pids)
        before_ns = cpu_ns(pids)
        time.sleep(window_s)
        return (cpu_ns(pids) - before_ns) / 1e6 / window_s


QUESTION = Question(
    "bridge",
    measure,
    (
        Goal("bridged round trip 64 B", BRIDGED, "within", 1.3, SUM),
        *(
            Goal("bridged throughput 1 MiB", name, "better", 0.8, FAST_DDS.name)
            for name in (INWARD, OUTWARD)
        ),
        *(
            Goal("bridged throughput 1 MiB, lost", name, "within", 0, statistic="largest")
            for name in (INWARD, OUTWARD)
        ),
        Goal(IDLE, BRIDGED, "within", 10),
        *images.GOALS,
    ),
    "ping outside on the first CPU, pong in cluster 2 on the second; inward process on the first; "
    "source on the first and sink on the second, bridge on that of the one inside; "
    + images.PLACEMENT,
)
