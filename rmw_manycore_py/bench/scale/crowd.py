# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""Time until many processes that start at one moment have all joined."""

from __future__ import annotations

from functools import partial

from rmw_manycore_py.bench.contenders import FAST_DDS, Middleware
from rmw_manycore_py.bench.question import Run
from rmw_manycore_py.bench.scale.common import (
    CLUSTERS,
    OWN,
    along,
    at_count,
    followed,
    on_curve,
)
from rmw_manycore_py.bench.session import Session
from rmw_manycore_py.bench.summary import Goal, Result

JOIN = "joining at one moment"
PUBLISHERS = {0: "", 5: ", 5 publishers each"}
PROCESSES = (50, 100, 200, 500)
# Its processes discover each other pairwise.
MAX_PROCESSES_OF_FAST_DDS = 100
ROUNDS = 5


def measure(run: Run) -> list[Result]:
    """Return the times, over the processes."""
    results: list[Result] = []
    for middleware in (OWN, FAST_DDS):
        for publishers, curve in PUBLISHERS.items():
            measured = partial(_join, run, middleware, publishers)
            name = f"{JOIN}: {middleware.name}{curve}"
            counts = followed(middleware, PROCESSES, MAX_PROCESSES_OF_FAST_DDS)
            results += along(run, name, counts, "processes", measured)
    return results


def _join(run: Run, middleware: Middleware, publishers: int, count: int) -> list[Result]:
    samples_s = []
    for _ in range(run.iterations(ROUNDS)):
        with Session(middleware, run.cpus) as session:
            found = session.native(
                "crowd",
                0,
                processes=count,
                publishers=publishers,
                clusters=CLUSTERS,
                cpu_a=run.cpus[0],
                cpu_b=run.cpus[1],
            ).finish()
        samples_s += [ns / 1e9 for ns in found["samples_ns"]]
    curve = f"{middleware.name}{PUBLISHERS[publishers]}"
    return [on_curve(JOIN, curve, count, "processes", "s", samples_s)]


GOALS = (
    Goal(JOIN, at_count(OWN.name, PROCESSES[-1], "processes"), "within", 1),
    Goal(JOIN, at_count(f"{OWN.name}{PUBLISHERS[5]}", 200, "processes"), "within", 1),
)
PLACEMENT = "crowd: half of the processes on each"
