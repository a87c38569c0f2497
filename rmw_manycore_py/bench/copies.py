# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""Time to take large messages in rclpy, with and without copies."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace

from rmw_manycore_py.bench.contenders import INSIDE, Middleware
from rmw_manycore_py.bench.question import PAYLOADS, Question, Run, for_each
from rmw_manycore_py.bench.rclpy_round_trip import with_malloc_tuning
from rmw_manycore_py.bench.round_trip import in_us
from rmw_manycore_py.bench.session import Session
from rmw_manycore_py.bench.summary import Goal, Result

SIZES = ("64 KiB", "1 MiB", "8 MiB")
FULL_MESSAGES = 100
WARM_UP = 10
FLAT_US = 40.0  # of a take, whatever the size


def _inside(zero_copy: str, name: str) -> Middleware:
    middleware = with_malloc_tuning(INSIDE, name)
    variables = {**middleware.variables, "MANYCORE_ZERO_COPY": zero_copy}
    return replace(middleware, variables=variables)


WITHOUT = _inside("sole", "without copies")
READ_ONLY = _inside("read_only", "without copies, read-only")
WITH = _inside("off", "with copies")


def measure(run: Run) -> list[Result]:
    """Measure all sizes in sequence."""
    results = []
    for size in SIZES:
        results += _measure_size(run, size)
    return results


def _measure_size(run: Run, size: str) -> list[Result]:
    messages = run.iterations(FULL_MESSAGES)

    def take(middleware: Middleware) -> Sequence[float]:
        with Session(middleware, run.cpus) as session:
            node = session.python("copies", 0, PAYLOADS[size], WARM_UP, messages)
            return in_us(node.finish()["samples_ns"])

    return run.interleave(_question(size), "us", for_each((WITHOUT, READ_ONLY, WITH), take))


def _question(size: str) -> str:
    return f"take and conversion of {size}"


QUESTION = Question(
    "copies",
    measure,
    (
        *(
            Goal(_question(size), contender.name, "within", FLAT_US)
            for size in SIZES
            for contender in (WITHOUT, READ_ONLY)
        ),
        Goal(_question("8 MiB"), WITHOUT.name, "better", 20.0, WITH.name),
    ),
    "publisher and subscription in one process, on one CPU",
)
