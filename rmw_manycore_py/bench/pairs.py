# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""Two builds of rmw_manycore beside each other: pairs of runs, and what differs between them."""

from __future__ import annotations

import math
import random
import statistics
from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Any

from rmw_manycore_py.bench.contenders import INSIDE, Middleware
from rmw_manycore_py.bench.question import PAYLOADS
from rmw_manycore_py.bench.session import Session, native_directory
from rmw_manycore_py.errors import EXIT_BAD_INPUT, ManycoreError

LIBRARY = "librmw_manycore.so"
SIZE = "64 B"
WARM_UP = 200
ROUND_TRIPS = 5000
MIN_PAIRS = 6
_RESAMPLES = 10_000
_SEED = 1  # the same pairs give the same interval


@dataclass(frozen=True)
class Comparison:
    """Medians of round trips in microseconds, pair by pair."""

    this_us: tuple[float, ...]
    other_us: tuple[float, ...]

    @property
    def differences_us(self) -> list[float]:
        """By how much this build takes longer than the other one, in each pair."""
        return [mine - its for mine, its in zip(self.this_us, self.other_us, strict=True)]

    def interval_us(self) -> tuple[float, float]:
        """Return the 95 % confidence interval of the median difference, from resampled pairs."""
        draw = random.Random(_SEED)
        differences = self.differences_us
        medians = sorted(
            statistics.median(draw.choices(differences, k=len(differences)))
            for _ in range(_RESAMPLES)
        )
        return medians[math.floor(0.025 * _RESAMPLES)], medians[math.ceil(0.975 * _RESAMPLES) - 1]

    def row(self) -> dict[str, Any]:
        """Return it for programs."""
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
    other: Path, pairs: int, cpus: tuple[int, int], note: Callable[[str], None]
) -> Comparison:
    """Run both builds in turns; which one begins changes from pair to pair."""
    if not (other / LIBRARY).is_file():
        raise ManycoreError(
            f"{other}: expected a directory with {LIBRARY}, found none; build one with "
            "cmake -S . -B build/other -DMANYCORE_TRACE=OFF (see docs/design/trace.md)",
            EXIT_BAD_INPUT,
        )
    sides = (
        # Both by the library path, or one of them would start with fewer look-ups.
        replace(INSIDE, name="this build", library=native_directory().parent),
        replace(INSIDE, name="other build", library=other.resolve()),
    )
    found: dict[str, list[float]] = {side.name: [] for side in sides}
    for run, side in enumerate(in_turns(*sides, pairs)):
        note(f"pair {run // 2 + 1} of {pairs}: {side.name}")
        found[side.name].append(statistics.median(_round_trips_us(side, cpus)))
    return Comparison(tuple(found["this build"]), tuple(found["other build"]))


def in_turns(one: Middleware, other: Middleware, pairs: int) -> Iterator[Middleware]:
    """Yield both for each pair, the one that was last first: a drift meets both alike."""
    for pair in range(pairs):
        yield from (one, other) if pair % 2 == 0 else (other, one)


def _round_trips_us(side: Middleware, cpus: tuple[int, int]) -> Sequence[float]:
    with Session(side, cpus) as session:
        ping = session.native(
            *("round_trip", 0),
            role="ping",
            bytes=PAYLOADS[SIZE],
            warm_up=WARM_UP,
            iterations=ROUND_TRIPS,
        )
        pong = session.native("round_trip", 1, role="pong")
        samples_ns = ping.finish()["samples_ns"]
        pong.finish()
    return [sample_ns / 1000 for sample_ns in samples_ns]
