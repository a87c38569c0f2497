# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""Scaling over threads, endpoints and nodes."""

from __future__ import annotations

from rmw_manycore_py.bench.question import Question, Run
from rmw_manycore_py.bench.scale import (
    churn,
    clients,
    clock,
    composed,
    crowd,
    endpoints,
    history,
    nodes,
    sim_time,
    sources,
    threads,
)
from rmw_manycore_py.bench.summary import Result

PARTS = (
    threads,
    composed,
    endpoints,
    sources,
    history,
    churn,
    clock,
    sim_time,
    clients,
    crowd,
    nodes,
)


def measure(run: Run) -> list[Result]:
    """Return the curves over threads, endpoints, kept messages, clients and nodes."""
    return [result for part in PARTS for result in part.measure(run)]


QUESTION = Question(
    "scale",
    measure,
    tuple(goal for part in PARTS for goal in part.GOALS),
    "; ".join(part.PLACEMENT for part in PARTS),
)
