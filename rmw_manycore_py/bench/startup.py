# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""Time from the start of an rclpy process to its first callback."""

from __future__ import annotations

from collections.abc import Sequence

from rmw_manycore_py.bench.contenders import BETWEEN, FAST_DDS, INSIDE, Middleware
from rmw_manycore_py.bench.question import Question, Run, for_each
from rmw_manycore_py.bench.session import Session
from rmw_manycore_py.bench.summary import Goal, Result

BY_HAND = "rclpy start to first message, by hand"
PREPARED = "rclpy start to first message, library path set"
FULL_ATTEMPTS = 4


def measure(run: Run) -> list[Result]:
    """Measure a node started by hand, and one started as by `manycore run`."""
    attempts = run.iterations(FULL_ATTEMPTS)

    def start(middleware: Middleware, *, by_hand: bool) -> Sequence[float]:
        return [_start(run, middleware, by_hand) for _ in range(attempts)]

    middlewares = (INSIDE, BETWEEN, FAST_DDS)
    by_hand = for_each(middlewares, lambda middleware: start(middleware, by_hand=True))
    prepared = for_each(middlewares, lambda middleware: start(middleware, by_hand=False))
    return [
        *run.interleave(BY_HAND, "ms", by_hand),
        *run.interleave(PREPARED, "ms", prepared),
    ]


def _start(run: Run, middleware: Middleware, by_hand: bool) -> float:
    with Session(middleware, run.cpus) as session:
        publisher = session.native("first_message", 0, role="publisher")
        publisher.wait_until_ready()
        node = session.python("first_message", 1, by_hand=by_hand)
        arrived_ns = node.finish()["arrived_ns"]
        publisher.release()
        publisher.finish()
    return float(arrived_ns - node.started_ns) / 1e6


QUESTION = Question(
    "startup",
    measure,
    tuple(
        Goal(question, middleware.name, "better", 1.3, FAST_DDS.name)
        for question in (BY_HAND, PREPARED)
        for middleware in (INSIDE, BETWEEN)
    ),
    "a native publisher on the first CPU, the rclpy node on the second",
)
