# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""What others feel while the endpoints of a topic are created, closed and killed.

The control does the same on another platform: it takes as much CPU time, and shares nothing else.
"""

from __future__ import annotations

from collections import defaultdict
from contextlib import closing
from functools import partial

from rmw_manycore_py.bench.contenders import INSIDE
from rmw_manycore_py.bench.load import awake
from rmw_manycore_py.bench.question import Run
from rmw_manycore_py.bench.round_trip import in_us
from rmw_manycore_py.bench.scale.common import along, at_count, on_curve, round_trips_us
from rmw_manycore_py.bench.session import TIMEOUT_S, Session
from rmw_manycore_py.bench.summary import Goal, Result

ROUND_TRIP = "round trip of 64 B while endpoints of a topic are created, closed and killed"
CREATE = "creating a publisher of another topic while endpoints are created, closed and killed"
ELSEWHERE = ", those on another platform"
ENDPOINTS = (100, 400, 800)
CHANGES = 200
TURNS = 5
ROUND_TRIPS = 2000
CREATED = 500


def measure(run: Run) -> list[Result]:
    """Return the times of round trips and of creating, over the endpoints; rmw_manycore only."""
    name = f"{ROUND_TRIP}: {INSIDE.name}"
    return along(run, name, ENDPOINTS, "endpoints", partial(_beside, run))


def _beside(run: Run, count: int) -> list[Result]:
    found: dict[tuple[str, str], list[float]] = defaultdict(list)
    with (
        Session(INSIDE, run.cpus) as own,
        Session(INSIDE, run.cpus) as other,
        awake(run.cpus, TIMEOUT_S),
    ):
        for _ in range(TURNS):
            for place, session in {"": own, ELSEWHERE: other}.items():
                churn = session.native(
                    "churn", 1, endpoints=count, changes=CHANGES, cpu=run.cpus[1]
                )
                with closing(churn):
                    churn.wait_until_ready()
                    found[ROUND_TRIP, place] += round_trips_us(
                        own, run.iterations(ROUND_TRIPS), pong=0
                    )
                    found[CREATE, place] += _creations_us(run, own)
    return [
        on_curve(question, f"{INSIDE.name}{place}", count, "endpoints", "us", samples)
        for (question, place), samples in found.items()
    ]


def _creations_us(run: Run, session: Session) -> list[float]:
    created = session.native(
        "matches",
        0,
        endpoints=0,
        iterations=run.iterations(CREATED),
        measure="other",
        depth=1,
    ).finish()
    return in_us(created["samples_ns"])


GOALS = tuple(
    Goal(
        question,
        at_count(INSIDE.name, count, "endpoints"),
        "within",
        1.2,
        at_count(f"{INSIDE.name}{ELSEWHERE}", count, "endpoints"),
        "p99",
    )
    for question in (ROUND_TRIP, CREATE)
    for count in ENDPOINTS
)
PLACEMENT = "churn: on the second, what it is measured with on the first"
