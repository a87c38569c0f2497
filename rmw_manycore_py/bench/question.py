# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""Shared by all questions: amount of measurement, and alternation of contenders."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, field
from pathlib import Path

from rmw_manycore_py.bench.contenders import (
    BETWEEN,
    FAST_DDS,
    INSIDE,
    MIB,
    TUNED_FAST_DDS,
    Middleware,
)
from rmw_manycore_py.bench.relations import Relation
from rmw_manycore_py.bench.summary import Goal, Result
from rmw_manycore_py.errors import ManycoreError

PAYLOADS = {"64 B": 64, "1 KiB": 1024, "64 KiB": 64 * 1024, "1 MiB": MIB, "8 MiB": 8 * MIB}

MIDDLEWARES = (INSIDE, BETWEEN, FAST_DDS, TUNED_FAST_DDS)

Measure = Callable[[], Sequence[float]]


@dataclass(frozen=True)
class Run:
    """Settings of one bench run: CPUs, amount, selection, progress callback.

    A failing contender is skipped from then on and added to `failures`; the others are measured.
    """

    cpus: tuple[int, int]
    rounds: int = 5
    share: float = 1.0
    only: tuple[str, ...] = ()
    note: Callable[[str], None] = lambda _: None
    failures: list[str] = field(default_factory=list)

    def iterations(self, full: int) -> int:
        """Return the number of iterations, given that of a full run."""
        return max(int(full * self.share), 4)

    def wants(self, name: str) -> bool:
        """Return whether a contender is selected; the filter matches "QUESTION: CONTENDER"."""
        return not self.only or any(part in name for part in self.only)

    def interleave(
        self,
        question: str,
        unit: str,
        contenders: Mapping[str, Measure],
        *,
        higher_is_better: bool = False,
    ) -> list[Result]:
        """Measure the contenders alternately, so that disturbances affect all of them."""
        samples: dict[str, list[float]] = {
            name: [] for name in contenders if self.wants(f"{question}: {name}")
        }
        remaining = list(samples)
        for turn in range(self.rounds):
            for name in tuple(remaining):
                self.note(f"{question}, round {turn + 1} of {self.rounds}: {name}")
                try:
                    samples[name].extend(contenders[name]())
                except ManycoreError as error:
                    self.failures.append(f"{question}: {name}: {error}")
                    remaining.remove(name)
        return [
            Result(question, name, unit, tuple(collected), higher_is_better)
            for name, collected in samples.items()
            if collected
        ]


@dataclass(frozen=True)
class Question:
    """A question, and the goals for its answers.

    `relations` finds which relations of a paper hold; `draw` writes figures beside the common plot
    into a directory, and returns their paths.
    """

    name: str
    measure: Callable[[Run], list[Result]]
    goals: tuple[Goal, ...] = ()
    placement: str = ""
    relations: Callable[[Sequence[Result]], list[Relation]] = lambda _: []
    draw: Callable[[Sequence[Result], Path], list[Path]] = lambda _results, _directory: []


def for_each(
    middlewares: Sequence[Middleware], measure: Callable[[Middleware], Sequence[float]]
) -> dict[str, Measure]:
    """Return one contender per middleware, all measured the same way."""

    def bound(middleware: Middleware) -> Measure:
        return lambda: measure(middleware)

    return {middleware.name: bound(middleware) for middleware in middlewares}
