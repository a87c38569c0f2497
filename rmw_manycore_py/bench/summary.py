# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""Statistics of results, and goals."""

from __future__ import annotations

import math
import statistics
from collections.abc import Sequence
from dataclasses import dataclass, field
from typing import Literal

Statistic = Literal["median", "mean", "p99", "largest"]
SPREAD = (0.05, 0.95)  # quantiles shown as the spread


@dataclass(frozen=True)
class Summary:
    """Numbers of a table row, in the unit of the samples."""

    samples: int
    median: float
    mean: float
    p99: float
    largest: float

    @classmethod
    def of(cls, samples: Sequence[float]) -> Summary:
        """Summarize at least one sample."""
        ordered = sorted(samples)
        return cls(
            samples=len(ordered),
            median=statistics.median(ordered),
            mean=statistics.fmean(ordered),
            p99=nearest_rank(ordered, 0.99),
            largest=ordered[-1],
        )


def nearest_rank(ordered: Sequence[float], share: float) -> float:
    """Return the smallest sample that at least `share` of all samples do not exceed."""
    return ordered[max(math.ceil(share * len(ordered)), 1) - 1]


@dataclass(frozen=True)
class Curve:
    """Position of a result on a curve, e.g. over the number of cores."""

    name: str
    at: int
    axis: str = "cores"


@dataclass(frozen=True)
class Result:
    """Samples of one contender at one question."""

    question: str
    contender: str
    unit: str
    samples: tuple[float, ...]
    higher_is_better: bool = False
    curve: Curve | None = None
    summary: Summary = field(init=False)

    def __post_init__(self) -> None:
        object.__setattr__(self, "summary", Summary.of(self.samples))


@dataclass(frozen=True)
class Goal:
    """Goal of a contender, relative to a peer or absolute.

    "within": at most `factor` times the peer (without a peer: at most `factor` units);
    "better": better than the peer by at least `factor`, in the direction that is better.
    """

    question: str
    contender: str
    kind: Literal["within", "better"]
    factor: float
    peer: str | None = None
    statistic: Statistic = "median"


@dataclass(frozen=True)
class Verdict:
    """A goal and what was measured; `found` is comparable with the goal's factor."""

    goal: Goal
    found: float

    @property
    def reached(self) -> bool:
        """Return whether the goal is reached."""
        goal = self.goal
        return self.found <= goal.factor if goal.kind == "within" else self.found >= goal.factor


def judge(results: Sequence[Result], goals: Sequence[Goal]) -> list[Verdict]:
    """Evaluate the goals whose two sides were measured."""
    by_name = {(result.question, result.contender): result for result in results}
    verdicts = []
    for goal in goals:
        own = by_name.get((goal.question, goal.contender))
        peer = by_name.get((goal.question, goal.peer)) if goal.peer else None
        if own and (peer or goal.peer is None):
            verdicts.append(Verdict(goal, _found(goal, own, peer)))
    return verdicts


def _found(goal: Goal, own: Result, peer: Result | None) -> float:
    own_value = float(getattr(own.summary, goal.statistic))
    if peer is None:
        return own_value
    peer_value = float(getattr(peer.summary, goal.statistic))
    if goal.kind == "better" and not own.higher_is_better:
        return _ratio(peer_value, own_value)
    return _ratio(own_value, peer_value)


def _ratio(numerator: float, denominator: float) -> float:
    if denominator == 0:
        return 1.0 if numerator == 0 else math.inf
    return numerator / denominator
