# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""Shared by all curves: placement, and the measured points."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Sequence
from dataclasses import replace

from rmw_manycore_py.bench.contenders import Middleware, manycore
from rmw_manycore_py.bench.question import Run
from rmw_manycore_py.bench.round_trip import WARM_UP, in_us
from rmw_manycore_py.bench.session import Session
from rmw_manycore_py.bench.summary import Curve, Result
from rmw_manycore_py.errors import ManycoreError

QUICK_SHARE = 0.1  # maximum share of a full run for which only half of each curve is measured
CLUSTERS = 5
OWN = replace(manycore("inside"), name=f"manycore in {CLUSTERS} clusters (block)")


def spread(middleware: Middleware, parties: int) -> Middleware:
    """Distribute the parties over the clusters; Fast DDS has none."""
    if not middleware.is_manycore:
        return middleware
    return replace(middleware, clusters=tuple(i % CLUSTERS + 1 for i in range(parties)))


def round_trips_us(session: Session, iterations: int, *, pong: int) -> list[float]:
    """Measure round trips of 64 B between party 0 and party `pong`."""
    ping = session.native(
        "round_trip", 0, role="ping", bytes=64, warm_up=WARM_UP, iterations=iterations
    )
    answering = session.native("round_trip", pong, role="pong")
    samples = in_us(ping.finish()["samples_ns"])
    answering.finish()
    return samples


def followed(middleware: Middleware, places: Sequence[int], most: int) -> Sequence[int]:
    """Return the points of a curve to which the middleware follows; Fast DDS up to `most`."""
    return [place for place in places if middleware.is_manycore or place <= most]


def along(
    run: Run,
    contender: str,
    places: Iterable[int],
    axis: str,
    measure: Callable[[int], list[Result]],
    fewest: int = 1,
) -> list[Result]:
    """Measure a contender, QUESTION: NAME, at the points of its curve in ascending order.

    The curve ends where the contender fails: larger points would fail as well, each after minutes.

    :param fewest: points that are measured in a quick run, too.
    """
    results: list[Result] = []
    for count in _drawn(run, places, fewest) if run.wants(contender) else ():
        place = at_count(contender, count, axis)
        run.note(place)
        try:
            results += measure(count)
        except ManycoreError as error:
            run.failures.append(f"{place}: {error}")
            break
    return results


def _drawn(run: Run, curve: Iterable[int], fewest: int) -> Sequence[int]:
    """Return the points of a curve that this run measures."""
    places = tuple(curve)
    return places[: max(len(places) // 2, fewest)] if run.share <= QUICK_SHARE else places


def on_curve(
    question: str, curve: str, at: int, axis: str, unit: str, samples: Sequence[float]
) -> Result:
    """Return the result at one point of a contender's curve."""
    name = at_count(curve, at, axis)
    return Result(question, name, unit, tuple(samples), curve=Curve(curve, at, axis))


def at_count(curve: str, at: int, axis: str) -> str:
    """Return the contender's name at one point of its curve."""
    return f"{curve}, {at} {axis}"
