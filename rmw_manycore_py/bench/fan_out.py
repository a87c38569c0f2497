# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""Age of 1 MiB messages at eight subscribers, at 100 Hz."""

from __future__ import annotations

from collections.abc import Sequence

from rmw_manycore_py.bench.contenders import INSIDE, MIB, TUNED_FAST_DDS, Middleware
from rmw_manycore_py.bench.question import MIDDLEWARES, Question, Run, for_each
from rmw_manycore_py.bench.round_trip import in_us
from rmw_manycore_py.bench.session import Session
from rmw_manycore_py.bench.summary import Goal, Result

SUBSCRIBERS = 8
RATE_HZ = 100
FULL_MESSAGES = 300
DEPTH = 10
WARM_UP = 100  # messages; then every sink has matched and every page is warm
NAME = "fan-out 1 MiB to 8"
LOST = f"{NAME}, lost"


def measure(run: Run) -> list[Result]:
    """Measure the one-way times of all subscribers, and their losses."""
    messages = run.iterations(FULL_MESSAGES)
    # A quick run only checks that everything works: deep queues, since CPU may be scarce.
    depth = DEPTH if messages == FULL_MESSAGES else WARM_UP + messages
    lost: dict[str, list[float]] = {}

    def spread(middleware: Middleware) -> Sequence[float]:
        with Session(middleware, run.cpus) as session:
            sinks = [
                session.native("fan_out", party, role="sink", depth=depth, best_effort=0)
                for party in range(1, SUBSCRIBERS + 1)
            ]
            source = session.native(
                "fan_out",
                0,
                role="source",
                depth=depth,
                best_effort=0,
                bytes=MIB,
                subscribers=SUBSCRIBERS,
                rate_hz=RATE_HZ,
                warm_up=WARM_UP,
                iterations=messages,
            )
            source.finish()
            found = [sink.finish()["samples_ns"] for sink in sinks]
        samples_ns = [sample_ns for samples_ns in found for sample_ns in samples_ns]
        lost.setdefault(middleware.name, []).append(SUBSCRIBERS * messages - len(samples_ns))
        return in_us(samples_ns)

    times = run.interleave(NAME, "us", for_each(MIDDLEWARES, spread))
    return times + [Result(LOST, name, "messages", tuple(counts)) for name, counts in lost.items()]


QUESTION = Question(
    "fan-out",
    measure,
    (
        Goal(NAME, INSIDE.name, "better", 2.0, TUNED_FAST_DDS.name),
        *(Goal(LOST, m.name, "within", 0, statistic="largest") for m in MIDDLEWARES[:2]),
    ),
    "publisher on the first CPU, subscribers on both in turn",
)
