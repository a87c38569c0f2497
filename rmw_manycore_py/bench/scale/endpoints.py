# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""Mutual cost of many publishers and subscriptions, of one topic or of as many."""

from __future__ import annotations

from functools import partial

from rmw_manycore_py.bench.contenders import FAST_DDS, INSIDE, Middleware
from rmw_manycore_py.bench.question import Run
from rmw_manycore_py.bench.scale.common import along, at_count, followed, on_curve
from rmw_manycore_py.bench.session import Session
from rmw_manycore_py.bench.summary import Goal, Result

CREATE = "creating a subscription"
CLOSE = "closing a subscription"
DEPART = "closing a publisher whose message is not taken"
RETIRE = "closing a publisher and a subscription of one of as many topics, a message in each"
BESIDE = "creating a publisher of another topic meanwhile"
PUBLISH = "publishing to a topic with as many publishers"
ENDPOINTS = (25, 50, 100, 200, 400, 800)
# Fast DDS matches endpoints pairwise by messages: more would take minutes.
MAX_ENDPOINTS_OF_FAST_DDS = 50
ITERATIONS = 200
FULL, ROOM = "queues full", "with room"
DEPTHS = {FULL: 1, ROOM: 1000}


def measure(run: Run) -> list[Result]:
    """Return the time for creating and publishing, over the endpoints of a topic."""
    results: list[Result] = []
    for middleware in (INSIDE, FAST_DDS):
        counts = followed(middleware, ENDPOINTS, MAX_ENDPOINTS_OF_FAST_DDS)
        measured = partial(_match, run, middleware)
        results += along(run, f"{PUBLISH}: {middleware.name}", counts, "endpoints", measured)
    return results


def _match(run: Run, middleware: Middleware, count: int) -> list[Result]:
    def samples_us(measure: str, depth: int) -> list[float]:
        with Session(middleware, run.cpus) as session:
            found = session.native(
                "matches",
                0,
                endpoints=count,
                iterations=run.iterations(ITERATIONS),
                measure=measure,
                depth=depth,
            ).finish()
        return [sample / 1e3 for sample in found["samples_ns"]]

    name = middleware.name
    # If the other thread got no CPU while few endpoints were created, it has no samples.
    beside = samples_us("beside", 1)
    return [
        on_curve(CREATE, name, count, "endpoints", "us", samples_us("create", 1)),
        on_curve(CLOSE, name, count, "endpoints", "us", samples_us("close", 1)),
        on_curve(DEPART, name, count, "endpoints", "us", samples_us("depart", 1)),
        on_curve(RETIRE, name, count, "endpoints", "us", samples_us("retire", 1)),
        *([on_curve(BESIDE, name, count, "endpoints", "us", beside)] if beside else []),
        *(
            on_curve(
                PUBLISH, f"{name}, {fill}", count, "endpoints", "us", samples_us("publish", depth)
            )
            for fill, depth in DEPTHS.items()
        ),
    ]


GOALS = (
    *(
        Goal(
            PUBLISH,
            at_count(f"{INSIDE.name}, {FULL}", count, "endpoints"),
            "within",
            2,
            at_count(f"{INSIDE.name}, {ROOM}", count, "endpoints"),
        )
        for count in ENDPOINTS
    ),
    Goal(  # eight times as many matches
        DEPART,
        at_count(INSIDE.name, 800, "endpoints"),
        "within",
        16,
        at_count(INSIDE.name, 100, "endpoints"),
    ),
    Goal(
        RETIRE,
        at_count(INSIDE.name, 800, "endpoints"),
        "within",
        2,
        at_count(INSIDE.name, 100, "endpoints"),
    ),
)
PLACEMENT = "endpoints: all in one process on the first"
