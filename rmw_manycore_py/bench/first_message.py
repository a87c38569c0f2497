# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""Time from rmw_init to the first message."""

from __future__ import annotations

from collections.abc import Sequence

from rmw_manycore_py.bench.contenders import BETWEEN, FAST_DDS, INSIDE, Middleware
from rmw_manycore_py.bench.question import Question, Run, for_each
from rmw_manycore_py.bench.session import Session
from rmw_manycore_py.bench.summary import Goal, Result

JOINING = "first message, joining a publisher"
ALONE = "first message, alone"
# In milliseconds from the call of rmw_init.
GOAL_MS = 10.0
FULL_ATTEMPTS = 4


def measure(run: Run) -> list[Result]:
    """Measure a process that joins others, and one that is the first of its system."""
    attempts = run.iterations(FULL_ATTEMPTS)

    def join(middleware: Middleware) -> Sequence[float]:
        return [_join(run, middleware) for _ in range(attempts)]

    def start_alone(middleware: Middleware) -> Sequence[float]:
        return [_start_alone(run, middleware) for _ in range(attempts)]

    return [
        *run.interleave(JOINING, "ms", for_each((INSIDE, BETWEEN, FAST_DDS), join)),
        *run.interleave(ALONE, "ms", for_each((INSIDE, FAST_DDS), start_alone)),
    ]


def _join(run: Run, middleware: Middleware) -> float:
    with Session(middleware, run.cpus) as session:
        publisher = session.native("first_message", 0, role="publisher")
        publisher.wait_until_ready()
        found = session.native("first_message", 1, role="joining").finish()
        publisher.release()
        publisher.finish()
    return float(found["samples_ns"][0]) / 1e6


def _start_alone(run: Run, middleware: Middleware) -> float:
    with Session(middleware, run.cpus) as session:
        found = session.native("first_message", 0, role="alone").finish()
    return float(found["samples_ns"][0]) / 1e6


QUESTION = Question(
    "first message",
    measure,
    (
        Goal(JOINING, INSIDE.name, "within", GOAL_MS),
        Goal(JOINING, BETWEEN.name, "within", GOAL_MS),
        Goal(ALONE, INSIDE.name, "within", GOAL_MS),
    ),
    "publisher on the first CPU, subscriber on the second; alone: on the first",
)
