# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""Mappings ranked by their simulation."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass
from statistics import fmean

from rmw_manycore_py.advice.problem import Clusters, Problem, Traffic
from rmw_manycore_py.advice.weights import Objective
from rmw_manycore_py.mapfile import Placement
from rmw_manycore_py.prediction import Prediction, Target, predict, sites_of
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
    """A mapping with its simulated run.

    :ivar incomplete: chains that no message passed here, though one did in another mapping.
    :ivar score: in the objective's unit, or relative; of the other chains.
    """

    candidate: Candidate
    prediction: Prediction
    incomplete: tuple[str, ...]
    score: float


@dataclass(frozen=True)
class Trial:
    """How candidates are simulated."""

    profile: Profile
    target: Target
    objective: Objective
    chain: tuple[str, ...]
    duration_s: float
    seed: int

    def predict(self, placement: Placement) -> Prediction:
        """Simulate a mapping."""
        return predict(
            sites_of(placement),
            self.profile,
            self.target,
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
    """Return the candidates, the best first; those with incomplete chains come last."""
    predictions = []
    for number, one in enumerate(candidates, start=1):
        report(f"simulating mapping {number} of {len(candidates)}: {one.name}")
        predictions.append(trial.predict(one.placement))
    scores = _scores(problem, candidates, predictions, trial.objective)
    found = map(Ranked, candidates, predictions, _incomplete(predictions), scores)
    return sorted(
        found,
        key=lambda one: (len(one.incomplete), one.score, _crossing(problem, one.candidate)),
    )


def _incomplete(predictions: Sequence[Prediction]) -> Iterator[tuple[str, ...]]:
    complete = [{chain.name for chain in one.chains if chain.samples_us} for one in predictions]
    known = set[str]().union(*complete)
    yield from (tuple(sorted(known - own)) for own in complete)


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
        yield from (one.busiest for one in predictions)
    elif objective == "bytes":
        for one in candidates:
            traffic = Traffic.of(problem.flows, one.clusters)
            yield traffic.bytes_per_s or traffic.messages_per_s
    else:
        yield from _of_times(predictions, objective)


def _of_times(predictions: Sequence[Prediction], objective: Objective) -> Iterator[float]:
    """Yield the mean over complete chains of their time / that of the best mapping for each."""
    times = [
        {chain.name: time for chain in one.chains if (time := time_us(chain, objective))}
        for one in predictions
    ]
    names = set[str]().union(*times)
    best = {name: min(own[name] for own in times if name in own) for name in names}
    for own in times:
        yield fmean(time / best[name] for name, time in own.items()) if own else 1.0


def time_us(chain: ChainTimes, objective: Objective) -> float | None:
    """Return the time of a chain that an objective is about."""
    if not chain.samples_us:
        return None
    if objective == "jitter":
        return max(chain.samples_us) - min(chain.samples_us) + 1.0
    return chain.quantile_us(1.0 if objective == "max" else 0.99)
