# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""Compares two builds of rmw_manycore in pairs of runs."""

from __future__ import annotations

import math
import random
import statistics
from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Any

from rmw_manycore_py.bench.contenders import BETWEEN, INSIDE, MIB, Middleware
from rmw_manycore_py.bench.question import PAYLOADS
from rmw_manycore_py.bench.session import Session, native_directory
from rmw_manycore_py.errors import EXIT_BAD_INPUT, ManycoreError

LIBRARY = "librmw_manycore.so"
WARM_UP = 200
ROUND_TRIPS = 5000
LARGE_ROUND_TRIPS = 500  # from 1 MiB
MIN_PAIRS = 6
_RESAMPLES = 10_000
_SEED = 1  # reproducible intervals


@dataclass(frozen=True)
class Comparison:
    """Median round trips in microseconds, per pair."""

    this_us: tuple[float, ...]
    other_us: tuple[float, ...]

    @property
    def differences_us(self) -> list[float]:
        """Excess time of this build over the other one, per pair."""
        return [mine - its for mine, its in zip(self.this_us, self.other_us, strict=True)]

    def interval_us(self) -> tuple[float, float]:
        """Return the 95 % confidence interval of the median difference (bootstrap over pairs)."""
        draw = random.Random(_SEED)
        differences = self.differences_us
        medians = sorted(
            statistics.median(draw.choices(differences, k=len(differences)))
            for _ in range(_RESAMPLES)
        )
        return medians[math.floor(0.025 * _RESAMPLES)], medians[math.ceil(0.975 * _RESAMPLES) - 1]

    def row(self) -> dict[str, Any]:
        """Return the JSON row."""
        low_us, high_us = self.interval_us()
        return {
            "pairs": len(self.this_us),
            "this_us": statistics.median(self.this_us),
            "other_us": statistics.median(self.other_us),
            "difference_us": statistics.median(self.differences_us),
            "interval_us": [low_us, high_us],
            "this_medians_us": list(self.this_us),
            "other_medians_us": list(self.other_us),
        }


def compare(
    other: Path,
    pairs: int,
    cpus: tuple[int, int],
    note: Callable[[str], None],
    *,
    size: str = "64 B",
    between: bool = False,
) -> Comparison:
    """Run both builds alternately; the order alternates between pairs.

    :param size: one of PAYLOADS.
    :param between: from one cluster to another, instead of inside of one.
    """
    if not (other / LIBRARY).is_file():
        raise ManycoreError(
            f"{other}: expected a directory with {LIBRARY}, found none; build one with "
            "cmake -S . -B build/other -DMANYCORE_TRACE=OFF (see docs/design/trace.md)",
            EXIT_BAD_INPUT,
        )
    place = BETWEEN if between else INSIDE
    sides = (
        # Select both by library path, so that both have the same number of look-ups.
        replace(place, name="this build", build=native_directory().parent),
        replace(place, name="other build", build=other.resolve()),
    )
    found: dict[str, list[float]] = {side.name: [] for side in sides}
    for run, side in enumerate(in_turns(*sides, pairs)):
        note(f"pair {run // 2 + 1} of {pairs}: {side.name}")
        found[side.name].append(statistics.median(_round_trips_us(side, cpus, PAYLOADS[size])))
    return Comparison(tuple(found["this build"]), tuple(found["other build"]))


def in_turns(one: Middleware, other: Middleware, pairs: int) -> Iterator[Middleware]:
    """Yield both for each pair in alternating order, so that drift affects both equally."""
    for pair in range(pairs):
        yield from (one, other) if pair % 2 == 0 else (other, one)


def _round_trips_us(side: Middleware, cpus: tuple[int, int], size_bytes: int) -> Sequence[float]:
    with Session(side, cpus) as session:
        ping = session.native(
            *("round_trip", 0),
            role="ping",
            bytes=size_bytes,
            warm_up=WARM_UP,
            iterations=ROUND_TRIPS if size_bytes < MIB else LARGE_ROUND_TRIPS,
        )
        pong = session.native("round_trip", 1, role="pong")
        samples_ns = ping.finish()["samples_ns"]
        pong.finish()
    return [sample_ns / 1000 for sample_ns in samples_ns]
