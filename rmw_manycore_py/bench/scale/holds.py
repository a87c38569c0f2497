# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""Hold times of the registry lock when a topic has many endpoints."""

from __future__ import annotations

from functools import partial

from rmw_manycore_py.bench.contenders import INSIDE
from rmw_manycore_py.bench.question import Run
from rmw_manycore_py.bench.scale.common import along, on_curve
from rmw_manycore_py.bench.session import Session
from rmw_manycore_py.bench.summary import Goal, Result

HOLD = "99 % of the holds of the registry lock end within"
LONGEST = "the longest hold of the registry lock"
OPERATIONS = {
    "create": "creating endpoints",
    "close_subscription": "closing subscriptions",
    "close_publisher": "closing publishers",
    "close_deep": "closing a publisher with 1,000 untaken messages",
    "close_server": "closing a server with 1,000 untaken replies",
    "free_large": "freeing a topic DSM of 16 MiB",
    "create_queue": "creating a subscription of depth 65,535",
    "free_queue": "freeing a subscription of depth 65,535",
    "reap": "reaping a killed process",
}
REPAIR = {"repair": "repairing after the owner of the lock was killed"}
CONTROL = {"control": "none, but arithmetic for 50 us, 10,000 times"}
FIGURES = {HOLD: ("_p99", OPERATIONS), LONGEST: ("", OPERATIONS | REPAIR | CONTROL)}
ENDPOINTS = (100, 200, 400, 800)
CHANGES = 50


def measure(run: Run) -> list[Result]:
    """Return the hold times of each operation, over the endpoints; rmw_manycore only."""
    return along(run, f"{HOLD}: {INSIDE.name}", ENDPOINTS, "endpoints", partial(_watch, run))


def _watch(run: Run, count: int) -> list[Result]:
    rounds = []
    for _ in range(run.rounds):
        with Session(INSIDE, run.cpus) as session:
            rounds.append(
                session.native(
                    "registry_holds", 0, endpoints=count, changes=CHANGES, cpu=run.cpus[1]
                ).finish()
            )
    return [
        on_curve(figure, _curve(operation), count, "endpoints", "us", samples)
        for figure, (suffix, operations) in FIGURES.items()
        for operation in operations
        if (samples := _samples(rounds, operation + suffix))
    ]


def _samples(rounds: list[dict[str, float]], name: str) -> list[float]:
    """Return the hold times, us, of the rounds in which one was observed."""
    return [holds[name] / 1e3 for holds in rounds if name in holds]


def _curve(operation: str) -> str:
    return f"{INSIDE.name}, {(OPERATIONS | REPAIR | CONTROL)[operation]}"


GOALS: tuple[Goal, ...] = ()  # the delay of other processes counts, not the length of a hold
PLACEMENT = "holds: all endpoints on the first, what watches the lock on the second"
