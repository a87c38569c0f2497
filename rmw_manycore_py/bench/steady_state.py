# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""Page faults and allocations per message in the steady state."""

from __future__ import annotations

from rmw_manycore_py.bench.contenders import BETWEEN, FAST_DDS, INSIDE, Middleware
from rmw_manycore_py.bench.question import PAYLOADS, Question, Run
from rmw_manycore_py.bench.session import Session
from rmw_manycore_py.bench.summary import Goal, Result

SIZES = ("64 B", "64 KiB", "1 MiB", "8 MiB")
KINDS = {"allocations": "allocations", "page_faults": "page faults"}
WARM_UP = 100
FULL_MESSAGES = 400


def measure(run: Run) -> list[Result]:
    """Count in both processes of a round trip; each takes and publishes every message."""
    results = []
    for size in SIZES:
        for middleware in (INSIDE, BETWEEN, FAST_DDS):
            if run.wants(middleware.name):
                run.note(f"steady state {size}: {middleware.name}")
                results += _count(run, middleware, size)
    return results


def _count(run: Run, middleware: Middleware, size: str) -> list[Result]:
    messages = run.iterations(FULL_MESSAGES)
    arguments = {"bytes": PAYLOADS[size], "warm_up": WARM_UP, "iterations": messages}
    with Session(middleware, run.cpus) as session:
        processes = [
            session.native("steady_state", party, role=role, **arguments)
            for party, role in enumerate(("ping", "pong"))
        ]
        found = [process.finish() for process in processes]
    return [
        Result(
            f"{words} per message, {size}",
            middleware.name,
            "count",
            tuple(counts[kind] / messages for counts in found),
        )
        for kind, words in KINDS.items()
    ]


QUESTION = Question(
    "steady state",
    measure,
    tuple(
        Goal(f"{words} per message, {size}", middleware.name, "within", 0, statistic="largest")
        for words in KINDS.values()
        for size in SIZES
        for middleware in (INSIDE, BETWEEN)
    ),
    "as in round trip; the samples are the two processes, each with all its threads",
)
