# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""What all curves share: where they lie, and how much of them is drawn."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from dataclasses import replace

from rmw_manycore_py.bench.contenders import Middleware, manycore
from rmw_manycore_py.bench.question import Run
from rmw_manycore_py.bench.summary import Curve, Result

QUICK_SHARE = 0.1  # of a run: then only the smaller half of each curve is drawn
CLUSTERS = 5
OWN = replace(manycore("inside"), name=f"manycore in {CLUSTERS} clusters (block)")


def spread(middleware: Middleware, parties: int) -> Middleware:
    """Put the parties into the clusters in turn; Fast DDS has none."""
    if not middleware.is_manycore:
        return middleware
    return replace(middleware, clusters=tuple(i % CLUSTERS + 1 for i in range(parties)))


def drawn(run: Run, curve: Iterable[int]) -> Sequence[int]:
    """Return the places of a curve that this run measures."""
    places = tuple(curve)
    return places[: len(places) // 2] if run.share <= QUICK_SHARE else places


def on_curve(
    question: str, curve: str, at: int, axis: str, unit: str, samples: Sequence[float]
) -> Result:
    """Return what was measured at one place of a contender's curve."""
    name = at_count(curve, at, axis)
    return Result(question, name, unit, tuple(samples), curve=Curve(curve, at, axis))


def at_count(curve: str, at: int, axis: str) -> str:
    """Return the contender's name at one place of its curve."""
    return f"{curve}, {at} {axis}"
