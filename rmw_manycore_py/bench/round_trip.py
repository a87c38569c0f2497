# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""Round-trip time at the rmw level."""

from __future__ import annotations

from collections.abc import Sequence

from rmw_manycore_py.bench.contenders import (
    BETWEEN,
    FAST_DDS,
    FUTEX,
    INSIDE,
    MIB,
    RELAY,
    TUNED_FAST_DDS,
    Middleware,
    Peer,
    manycore,
)
from rmw_manycore_py.bench.question import MIDDLEWARES, PAYLOADS, Measure, Question, Run, for_each
from rmw_manycore_py.bench.session import Session, run_peer
from rmw_manycore_py.bench.summary import Goal, Result, Statistic

SIZES = ("64 B", "64 KiB", "1 MiB", "8 MiB")
WARM_UP = 50
# A spinning node keeps the receive thread of its cluster off the CPU they share here. `spin` needs
# a CPU of its own, so it is omitted between clusters.
OTHER_WAITS = (
    manycore("inside", "adaptive"),
    manycore("inside", "spin"),
    manycore("between", "adaptive"),
)
ADAPTIVE_BETWEEN = OTHER_WAITS[2]
# Variation of two medians of the same thing between runs.
NOISE = 1.05


def iterations(size_bytes: int) -> int:
    """Return the messages of a full round: about a second of the slowest contender."""
    return 2000 if size_bytes < MIB else 400 if size_bytes == MIB else 80


def measure(run: Run) -> list[Result]:
    """Measure all sizes in sequence."""
    results = []
    for size in SIZES:
        results += run.interleave(f"round trip {size}", "us", _contenders(run, PAYLOADS[size]))
    return results


def _contenders(run: Run, size_bytes: int) -> dict[str, Measure]:
    arguments = {
        "bytes": size_bytes,
        "warm_up": WARM_UP,
        "iterations": run.iterations(iterations(size_bytes)),
    }

    def talk(middleware: Middleware) -> Sequence[float]:
        with Session(middleware, run.cpus) as session:
            ping = session.native("round_trip", 0, role="ping", **arguments)
            pong = session.native("round_trip", 1, role="pong")
            found = ping.finish()
            pong.finish()
        return in_us(found["samples_ns"])

    def ask(peer: Peer) -> Measure:
        return lambda: in_us(run_peer(peer, run.cpus, **arguments)["samples_ns"])

    peers = {peer.name: ask(peer) for peer in (FUTEX, RELAY)}
    return {**peers, **for_each((*MIDDLEWARES, *OTHER_WAITS), talk)}


def in_us(samples_ns: Sequence[int]) -> list[float]:
    """Convert nanoseconds to microseconds."""
    return [sample_ns / 1e3 for sample_ns in samples_ns]


def _goals() -> tuple[Goal, ...]:
    goals = [
        Goal("round trip 64 B", other.name, "within", 5.0)
        for other in OTHER_WAITS
        if other is not ADAPTIVE_BETWEEN
    ]
    for size in SIZES:
        goals += _goals_of(f"round trip {size}", size)
    return tuple(goals)


def _goals_of(question: str, size: str) -> list[Goal]:
    machine = {"64 B": 1.2, "64 KiB": 1.2, "1 MiB": 1.4, "8 MiB": 1.4}[size]
    installed = {"64 B": (1.5, 1.2), "64 KiB": (1.6, 1.6), "1 MiB": (2, 2), "8 MiB": (2.7, 2.7)}
    tuned = {"64 B": (1.5, 1.2), "64 KiB": (1.15, 1.15), "1 MiB": (1.7, 1.7), "8 MiB": (2.7, 2.7)}
    statistics: tuple[tuple[Statistic, float | None], ...] = (
        (("median", None), ("mean", 10.0)) if size == "1 MiB" else (("median", None),)
    )
    goals = []
    for middleware, peer, column in ((INSIDE, FUTEX, 0), (BETWEEN, RELAY, 1)):
        name = middleware.name
        goals.append(Goal(question, name, "within", machine, peer.name))
        for statistic, factor in statistics:
            goal = factor or installed[size][column]
            goals.append(Goal(question, name, "better", goal, FAST_DDS.name, statistic))
        goals.append(Goal(question, name, "better", tuned[size][column], TUNED_FAST_DDS.name))
    goals.append(Goal(question, ADAPTIVE_BETWEEN.name, "within", NOISE, BETWEEN.name))
    return goals


QUESTION = Question(
    "round trip",
    measure,
    _goals(),
    "ping on the first CPU, pong on the second; between clusters each has the receive thread of "
    "its cluster (the peer: its relay) on its own CPU",
)
