# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""Cost of a message for one thread of a process in which many threads wait."""

from __future__ import annotations

from functools import partial

from rmw_manycore_py.bench.contenders import BETWEEN, FAST_DDS, INSIDE, Middleware
from rmw_manycore_py.bench.question import Run
from rmw_manycore_py.bench.scale.common import along, at_count, on_curve
from rmw_manycore_py.bench.session import Session
from rmw_manycore_py.bench.summary import Goal, Result

SLEEPS = "sleeps of a process per message to one of its threads"
CPU = "CPU time of a process per message to one of its threads"
THREADS = (1, 8, 32, 63, 128)
MESSAGES = 200
RATE_HZ = 200


def measure(run: Run) -> list[Result]:
    """Return voluntary switches and CPU time of a process per message, over its threads."""
    results: list[Result] = []
    for middleware in (INSIDE, BETWEEN, FAST_DDS):
        measured = partial(_compose, run, middleware)
        results += along(run, f"{SLEEPS}: {middleware.name}", THREADS, "threads", measured)
    return results


def _compose(run: Run, middleware: Middleware, threads: int) -> list[Result]:
    messages = run.iterations(MESSAGES)
    with Session(middleware, run.cpus) as session:
        sink = session.native("composition", 1, role="sink", threads=threads, messages=messages)
        sink.wait_until_ready()
        source = session.native(
            "composition", 0, role="source", threads=threads, messages=messages, rate_hz=RATE_HZ
        )
        source.finish()
        found = sink.finish()
    counted = messages - 1  # intervals from the first to the last
    return [
        on_curve(
            question, middleware.name, threads, "threads", unit, [found[key] / counted / scale]
        )
        for question, key, unit, scale in (
            (SLEEPS, "sleeps", "count", 1),
            (CPU, "cpu_ns", "us", 1e3),
        )
    ]


GOALS = tuple(
    Goal(SLEEPS, at_count(middleware.name, threads, "threads"), "within", 2)
    for middleware in (INSIDE, BETWEEN)
    for threads in THREADS
)
PLACEMENT = "threads: source on the first CPU, the process with the threads on the second"
