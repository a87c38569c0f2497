# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""Hold times of the registry lock when a topic has many endpoints."""

from __future__ import annotations

from functools import partial

from rmw_manycore_py.bench.contenders import INSIDE
from rmw_manycore_py.bench.question import Run
from rmw_manycore_py.bench.scale.common import along, at_count, on_curve
from rmw_manycore_py.bench.session import Session
from rmw_manycore_py.bench.summary import Goal, Result

HOLD = "99 % of the holds of the registry lock end within"
OPERATIONS = {
    "create": "creating endpoints",
    "close_subscription": "closing subscriptions",
    "close_publisher": "closing publishers",
    "sweep": "sweeping what they left",
    "free_large": "freeing a topic DSM of 16 MiB",
    "reap": "reaping a killed process",
}
ENDPOINTS = (100, 200, 400, 800)
CHANGES = 10
MOST_US = 100


def measure(run: Run) -> list[Result]:
    """Return the hold times of each operation, over the endpoints; rmw_manycore only."""
    return along(run, f"{HOLD}: {INSIDE.name}", ENDPOINTS, "endpoints", partial(_watch, run))


def _watch(run: Run, count: int) -> list[Result]:
    found: dict[str, list[float]] = {operation: [] for operation in OPERATIONS}
    for _ in range(run.rounds):
        with Session(INSIDE, run.cpus) as session:
            holds = session.native(
                "registry_holds", 0, endpoints=count, changes=CHANGES, cpu=run.cpus[1]
            ).finish()
        for operation, samples in found.items():
            if (hold_ns := holds.get(f"{operation}_p99")) is not None:  # observed at least once
                samples.append(hold_ns / 1e3)
    return [
        on_curve(HOLD, _curve(operation), count, "endpoints", "us", samples)
        for operation, samples in found.items()
        if samples
    ]


def _curve(operation: str) -> str:
    return f"{INSIDE.name}, {OPERATIONS[operation]}"


GOALS = tuple(
    Goal(HOLD, at_count(_curve(operation), ENDPOINTS[-1], "endpoints"), "within", MOST_US)
    for operation in OPERATIONS
)
PLACEMENT = "holds: all endpoints on the first, what watches the lock on the second"
