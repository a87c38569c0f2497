# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""Round-trip time through rclpy."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace

from rmw_manycore_py.bench.contenders import (
    BETWEEN,
    FAST_DDS,
    INSIDE,
    MIB,
    TUNED_FAST_DDS,
    Middleware,
)
from rmw_manycore_py.bench.question import PAYLOADS, Question, Run, for_each
from rmw_manycore_py.bench.round_trip import in_us
from rmw_manycore_py.bench.session import Session
from rmw_manycore_py.bench.summary import Goal, Result

SIZES = ("64 B", "1 MiB", "8 MiB")
WARM_UP = 20

# Memory settings of `manycore run`: freed memory is kept for the next message.
MALLOC_TUNING = {"MALLOC_TRIM_THRESHOLD_": str(2**30), "MALLOC_MMAP_THRESHOLD_": str(2**30)}


def with_malloc_tuning(middleware: Middleware, name: str) -> Middleware:
    """Return the middleware with the malloc settings of `manycore run`."""
    return replace(middleware, name=name, variables={**middleware.variables, **MALLOC_TUNING})


RUN_INSIDE = with_malloc_tuning(INSIDE, "manycore run, inside (block)")
RUN_BETWEEN = with_malloc_tuning(BETWEEN, "manycore run, between (block)")
MIDDLEWARES = (
    RUN_INSIDE,
    RUN_BETWEEN,
    FAST_DDS,
    TUNED_FAST_DDS,
    # Isolates the effect of the malloc settings, on either side.
    INSIDE,
    with_malloc_tuning(TUNED_FAST_DDS, "Fast DDS, 128 MB segment, malloc"),
)


def iterations(size_bytes: int) -> int:
    """Return the number of messages of a full round."""
    return 1000 if size_bytes < MIB else 200 if size_bytes == MIB else 50


def measure(run: Run) -> list[Result]:
    """Measure all sizes in sequence."""
    results = []
    for size in SIZES:
        results += _measure_size(run, size)
    return results


def _measure_size(run: Run, size: str) -> list[Result]:
    messages = run.iterations(iterations(PAYLOADS[size]))

    def talk(middleware: Middleware) -> Sequence[float]:
        with Session(middleware, run.cpus) as session:
            pong = session.python("pong", 1)
            ping = session.python("ping", 0, PAYLOADS[size], WARM_UP, messages)
            found = ping.finish()
            pong.finish()
        return in_us(found["samples_ns"])

    return run.interleave(f"rclpy round trip {size}", "us", for_each(MIDDLEWARES, talk))


def _goals() -> tuple[Goal, ...]:
    factors = {"64 B": (1.2, 1.15), "1 MiB": (10.0, 2.5), "8 MiB": (3.0, 2.0)}
    return tuple(
        Goal(f"rclpy round trip {size}", RUN_INSIDE.name, "better", factor, peer.name)
        for size in SIZES
        for peer, factor in zip((FAST_DDS, TUNED_FAST_DDS), factors[size], strict=True)
    )


QUESTION = Question(
    "rclpy round trip",
    measure,
    _goals(),
    "as in round trip; SingleThreadedExecutor on both sides",
)
