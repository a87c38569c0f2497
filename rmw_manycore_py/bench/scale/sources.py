# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""What a subscription pays for each of many publishers, in time and in memory."""

from __future__ import annotations

from functools import partial

from rmw_manycore_py.bench.contenders import INSIDE
from rmw_manycore_py.bench.question import Run
from rmw_manycore_py.bench.round_trip import in_us
from rmw_manycore_py.bench.scale.common import along, at_count, on_curve
from rmw_manycore_py.bench.session import Session
from rmw_manycore_py.bench.summary import Goal, Result

RESYNC = "a subscription looks into all its publishers"
BYTES = "SMEM of a match"
PUBLISHERS = (25, 50, 100, 200, 400, 800)
ITERATIONS = 200
NEWS = {0: "nothing new", 1: "a message in each"}


def measure(run: Run) -> list[Result]:
    """Return what a look takes and a match holds, over the publishers; Fast DDS has neither."""
    look = partial(_look, run)
    return along(run, f"{RESYNC}: {INSIDE.name}", PUBLISHERS, "publishers", look)


def _look(run: Run, count: int) -> list[Result]:
    results = []
    for news, name in NEWS.items():
        with Session(INSIDE, run.cpus) as session:
            found = session.native(
                "sources",
                0,
                publishers=count,
                iterations=run.iterations(ITERATIONS),
                news=news,
            ).finish()
        samples = in_us(found["samples_ns"])
        results.append(on_curve(RESYNC, _curve(name), count, "publishers", "us", samples))
    bytes_each = found["match_bytes"] / count**2
    return [
        *results,
        on_curve(BYTES, INSIDE.name, count, "publishers", "bytes", [bytes_each]),
    ]


def _curve(news: str) -> str:
    return f"{INSIDE.name}, {news}"


GOALS = (
    # In proportion to the publishers, times a logarithm, and that they no longer fit the caches.
    *(
        Goal(
            RESYNC,
            at_count(_curve(news), PUBLISHERS[-1], "publishers"),
            "within",
            2 * PUBLISHERS[-1] / PUBLISHERS[2],
            at_count(_curve(news), PUBLISHERS[2], "publishers"),
        )
        for news in NEWS.values()
    ),
    Goal(BYTES, at_count(INSIDE.name, PUBLISHERS[-1], "publishers"), "within", 100),
)
PLACEMENT = "publishers: all in one process on the first"
