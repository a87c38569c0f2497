# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""Messages per second without loss, with eight in flight."""

from __future__ import annotations

from collections.abc import Sequence

from rmw_manycore_py.bench.contenders import FAST_DDS, INSIDE, TUNED_FAST_DDS, Middleware
from rmw_manycore_py.bench.question import MIDDLEWARES, PAYLOADS, Question, Run, for_each
from rmw_manycore_py.bench.session import Session
from rmw_manycore_py.bench.summary import Goal, Result

IN_FLIGHT = 8
SMALL = ("64 B", "1 KiB")
LARGE = ("64 KiB", "1 MiB", "8 MiB")
# Messages per sample, and samples of a full round.
STRETCH = {"64 B": 400, "1 KiB": 400, "64 KiB": 160, "1 MiB": 40, "8 MiB": 8}
FULL_STRETCHES = 50
WARM_UP_STRETCHES = 3


def measure(run: Run) -> list[Result]:
    """Measure all sizes in sequence."""
    results = []
    for size in (*SMALL, *LARGE):
        results += _measure_size(run, size)
    return results


def _measure_size(run: Run, size: str) -> list[Result]:
    stretch = STRETCH[size]
    lost: dict[str, list[float]] = {}

    def flood(middleware: Middleware) -> Sequence[float]:
        with Session(middleware, run.cpus) as session:
            source = session.native(
                "throughput",
                0,
                role="source",
                bytes=PAYLOADS[size],
                in_flight=IN_FLIGHT,
                warm_up=WARM_UP_STRETCHES * stretch,
                stretch=stretch,
                stretches=run.iterations(FULL_STRETCHES),
            )
            sink = session.native("throughput", 1, role="sink")
            found = source.finish()
            sink.finish()
        lost.setdefault(middleware.name, []).append(found["lost"])
        return [stretch / sample_ns * 1e9 for sample_ns in found["samples_ns"]]

    rates = run.interleave(
        f"throughput {size}", "1/s", for_each(MIDDLEWARES, flood), higher_is_better=True
    )
    losses = [
        Result(f"throughput {size}, lost", name, "messages", tuple(counts))
        for name, counts in lost.items()
    ]
    return rates + losses


def _goals() -> tuple[Goal, ...]:
    goals = []
    for size in (*SMALL, *LARGE):
        factors = (1.8, 1.8) if size in SMALL else (5.0, 1.1)
        for peer, factor in zip((FAST_DDS, TUNED_FAST_DDS), factors, strict=True):
            goals.append(Goal(f"throughput {size}", INSIDE.name, "better", factor, peer.name))
        for middleware in MIDDLEWARES[:2]:
            question = f"throughput {size}, lost"
            goals.append(Goal(question, middleware.name, "within", 0, statistic="largest"))
    return tuple(goals)


QUESTION = Question(
    "throughput",
    measure,
    _goals(),
    "source on the first CPU, sink on the second, each with the receive thread of its cluster",
)
