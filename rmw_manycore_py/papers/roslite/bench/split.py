# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""Fig. 15: one pass over clusters of derivatives, with two and three of radius search."""

from __future__ import annotations

from functools import partial

from rmw_manycore_py.bench.question import Run
from rmw_manycore_py.bench.summary import Result
from rmw_manycore_py.papers.roslite.bench.drives import drive, nothing
from rmw_manycore_py.papers.roslite.variants import AFTER, installed, only_localizer, with_split

QUESTION = "one pass"
DERIVATIVES, SEARCHES = range(1, 6), (2, 3)
SCANS = 200


def contender(derivatives: int, searches: int) -> str:
    """Return how results name a split."""
    return f"{derivatives} derivatives, {searches} radius_search"


def measure(run: Run) -> list[Result]:
    """Measure each split in turns; the vehicle stands, so all see the same."""

    def passes(derivatives: int, searches: int) -> list[float]:
        split = with_split(installed(AFTER), derivatives, searches)
        scans = max(run.iterations(SCANS) // run.rounds, 1)
        figures, _ = drive(only_localizer(split), scans, drives=False, meanwhile=nothing)
        return figures.loop_ms

    contenders = {
        contender(derivatives, searches): partial(passes, derivatives, searches)
        for searches in SEARCHES
        for derivatives in DERIVATIVES
    }
    return run.interleave(QUESTION, "ms", contenders)
