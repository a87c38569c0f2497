# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""What all questions share: how much to measure, and taking turns."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass

from rmw_manycore_py.bench.contenders import (
    BETWEEN,
    FAST_DDS,
    INSIDE,
    MIB,
    TUNED_FAST_DDS,
    Middleware,
)
from rmw_manycore_py.bench.summary import Goal, Result

PAYLOADS = {"64 B": 64, "1 KiB": 1024, "64 KiB": 64 * 1024, "1 MiB": MIB, "8 MiB": 8 * MIB}

MIDDLEWARES = (INSIDE, BETWEEN, FAST_DDS, TUNED_FAST_DDS)

Measure = Callable[[], Sequence[float]]


@dataclass(frozen=True)
class Run:
    """One call of a bench: where it runs, how much of it, and who hears about the progress."""

    cpus: tuple[int, int]
    rounds: int = 5
    share: float = 1.0
    only: tuple[str, ...] = ()
    note: Callable[[str], None] = lambda _: None

    def iterations(self, full: int) -> int:
        """Return how often to repeat what is repeated `full` times in a full run."""
        return max(int(full * self.share), 4)

    def wants(self, name: str) -> bool:
        """Tell whether a contender takes part; QUESTION: CONTENDER tells it from others."""
        return not self.only or any(part in name for part in self.only)

    def interleave(
        self,
        question: str,
        unit: str,
        contenders: Mapping[str, Measure],
        *,
        higher_is_better: bool = False,
    ) -> list[Result]:
        """Let the contenders take turns, so that a disturbance of the machine meets them all."""
        samples: dict[str, list[float]] = {
            name: [] for name in contenders if self.wants(f"{question}: {name}")
        }
        for turn in range(self.rounds):
            for name, collected in samples.items():
                self.note(f"{question}, round {turn + 1} of {self.rounds}: {name}")
                collected.extend(contenders[name]())
        return [
            Result(question, name, unit, tuple(collected), higher_is_better)
            for name, collected in samples.items()
        ]


@dataclass(frozen=True)
class Question:
    """One question with the goals its answers are held against."""

    name: str
    measure: Callable[[Run], list[Result]]
    goals: tuple[Goal, ...] = ()
    placement: str = ""


def for_each(
    middlewares: Sequence[Middleware], measure: Callable[[Middleware], Sequence[float]]
) -> dict[str, Measure]:
    """Return the contenders of a question that is put to each middleware in the same way."""

    def bound(middleware: Middleware) -> Measure:
        return lambda: measure(middleware)

    return {middleware.name: bound(middleware) for middleware in middlewares}
