# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""Cost of publishing beside the history that a transient-local publisher keeps."""

from __future__ import annotations

from functools import partial

from rmw_manycore_py.bench.contenders import FAST_DDS, INSIDE, Middleware
from rmw_manycore_py.bench.question import Run
from rmw_manycore_py.bench.round_trip import in_us
from rmw_manycore_py.bench.scale.common import along, at_count, on_curve
from rmw_manycore_py.bench.session import Session
from rmw_manycore_py.bench.summary import Goal, Result

PUBLISH = "publishing by a transient-local publisher that keeps a full history"
DEPTHS = (1, 10, 100, 1000, 10_000)
ITERATIONS = 1000


def measure(run: Run) -> list[Result]:
    """Return the time of a publish, over the depth of the history."""
    results: list[Result] = []
    for middleware in (INSIDE, FAST_DDS):
        measured = partial(_publish, run, middleware)
        results += along(run, f"{PUBLISH}: {middleware.name}", DEPTHS, "messages kept", measured)
    return results


def _publish(run: Run, middleware: Middleware, depth: int) -> list[Result]:
    iterations = run.iterations(ITERATIONS)
    with Session(middleware, run.cpus) as session:
        found = session.native("history", 0, depth=depth, iterations=iterations).finish()
    samples = in_us(found["samples_ns"])
    return [on_curve(PUBLISH, middleware.name, depth, "messages kept", "us", samples)]


_shallow, *_deep = (at_count(INSIDE.name, depth, "messages kept") for depth in DEPTHS)
GOALS = tuple(Goal(PUBLISH, deep, "within", 2, _shallow) for deep in _deep)
PLACEMENT = "history: publisher and subscription in one process on the first"
