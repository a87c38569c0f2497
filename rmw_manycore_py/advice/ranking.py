# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""Mappings in the order of what a simulation says of them."""

from __future__ import annotations

import math
from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass

from rmw_manycore_py.advice.problem import Clusters, Problem, Traffic
from rmw_manycore_py.advice.weights import Objective
from rmw_manycore_py.mapfile import Placement
from rmw_manycore_py.prediction import TARGETS, Prediction, predict, sites_of
from rmw_manycore_py.prediction.prediction import ChainTimes
from rmw_manycore_py.profile.model import Profile

NOW = "as it is"


@dataclass(frozen=True)
class Candidate:
    """A mapping as it would be written.

    :param name: what it was searched for.
    :param is_best: whether none is better for that.
    :param placement: of its mapfile, which has passed all checks.
    """

    name: str
    clusters: Clusters
    text: str
    placement: Placement
    is_best: bool


@dataclass(frozen=True)
class Ranked:
    """A mapping with its simulated run; `score` is in the objective's unit, or relative."""

    candidate: Candidate
    prediction: Prediction
    score: float


@dataclass(frozen=True)
class Trial:
    """How candidates are simulated."""

    profile: Profile
    objective: Objective
    chain: tuple[str, ...]
    duration_s: float
    seed: int

    def predict(self, placement: Placement) -> Prediction:
        """Simulate a mapping."""
        return predict(
            sites_of(placement),
            self.profile,
            TARGETS[placement.topology.profile],
            seed=self.seed,
            duration_s=self.duration_s,
            chains=[self.chain] if self.chain else None,
        )


def ranked(
    problem: Problem,
    candidates: Sequence[Candidate],
    trial: Trial,
    report: Callable[[str], None] = lambda _: None,
) -> list[Ranked]:
    """Return the candidates, the best first."""
    predictions = []
    for number, one in enumerate(candidates, start=1):
        report(f"simulating mapping {number} of {len(candidates)}: {one.name}")
        predictions.append(trial.predict(one.placement))
    scores = _scores(problem, candidates, predictions, trial.objective)
    found = map(Ranked, candidates, predictions, scores)
    return sorted(found, key=lambda one: (one.score, _crossing(problem, one.candidate)))


def _crossing(problem: Problem, candidate: Candidate) -> float:
    """Return the messages between clusters, which decide where scores are equal."""
    return Traffic.of(problem.flows, candidate.clusters).messages_per_s


def _scores(
    problem: Problem,
    candidates: Sequence[Candidate],
    predictions: Sequence[Prediction],
    objective: Objective,
) -> Iterator[float]:
    if objective == "load":
        yield from (max(core.cpu_share for core in one.cores) for one in predictions)
    elif objective == "bytes":
        for one in candidates:
            traffic = Traffic.of(problem.flows, one.clusters)
            yield traffic.bytes_per_s or traffic.messages_per_s
    else:
        yield from _of_times(predictions, objective)


def _of_times(predictions: Sequence[Prediction], objective: Objective) -> Iterator[float]:
    """Yield the mean over all chains of their time / that of the best mapping for the chain."""
    times = [{chain.name: time_us(chain, objective) for chain in one.chains} for one in predictions]
    names = sorted({name for own in times for name, time in own.items() if time is not None})
    best = {name: min(own.get(name) or math.inf for own in times) for name in names}
    for own in times:
        # A chain that no message passed is worse than any other.
        shares = [(own.get(name) or math.inf) / best[name] for name in names]
        yield sum(shares) / len(shares) if shares else 1.0


def time_us(chain: ChainTimes, objective: Objective) -> float | None:
    """Return the time of a chain that an objective is about."""
    if not chain.samples_us:
        return None
    if objective == "jitter":
        return max(chain.samples_us) - min(chain.samples_us) + 1.0
    return chain.quantile_us(1.0 if objective == "max" else 0.99)
