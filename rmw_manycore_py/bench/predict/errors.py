# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""Errors of predictions, and how well they order mappings."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from itertools import combinations
from statistics import median

from rmw_manycore_py.bench.predict.figures import Figures, typical
from rmw_manycore_py.bench.predict.runs import Compared

LIGHT = 0.60  # load per CPU up to which a mapping counts for the goals


@dataclass(frozen=True)
class MappingError:
    """Errors of a mapping: relative ones of its chains, in points of its loads.

    :ivar repeated_p50: errors of each run's p50 if it is predicted by the median of the others:
        no prediction of one run can be better. `repeated_p99` likewise.
    :ivar others: share of the CPUs that other processes took, at most.
    """

    number: int
    load: float
    p50: tuple[float, ...]
    p99: tuple[float, ...]
    repeated_p50: tuple[float, ...]
    repeated_p99: tuple[float, ...]
    load_points: float
    others: float

    @property
    def is_light(self) -> bool:
        """Whether no CPU was loaded by 60 % or more."""
        return self.load < LIGHT


def error_of(one: Compared) -> MappingError:
    """Return the errors of a mapping against the medians of its runs."""
    measured = typical(one.runs)
    pairs = [(one.predicted.chains[name], measured.chains[name]) for name in _common(one)]
    points = [abs(one.predicted.cpus.get(cpu, 0.0) - load) for cpu, load in measured.cpus.items()]
    return MappingError(
        one.number,
        max(measured.cpus.values(), default=0.0),
        tuple(predicted.p50_us / found.p50_us - 1 for predicted, found in pairs),
        tuple(predicted.p99_us / found.p99_us - 1 for predicted, found in pairs),
        tuple(error for name in _common(one) for error in _repeated(_p50s(one.runs, name))),
        tuple(error for name in _common(one) for error in _repeated(_p99s(one.runs, name))),
        100 * max(points, default=0.0),
        measured.others,
    )


def _common(one: Compared) -> list[str]:
    """Return the chains with enough messages in each run and in the prediction."""
    known = set(one.predicted.chains).intersection(*(run.chains for run in one.runs))
    return sorted(known)


def _p50s(runs: Sequence[Figures], name: str) -> list[float]:
    return [run.chains[name].p50_us for run in runs]


def _p99s(runs: Sequence[Figures], name: str) -> list[float]:
    return [run.chains[name].p99_us for run in runs]


def _repeated(of_runs_us: Sequence[float]) -> Iterator[float]:
    for index, of_run_us in enumerate(of_runs_us):
        if others := [*of_runs_us[:index], *of_runs_us[index + 1 :]]:
            yield median(others) / of_run_us - 1


@dataclass(frozen=True)
class Order:
    """Pairs of mappings whose measured intervals do not overlap, and Kendall's tau over them."""

    pairs: int
    tau: float | None


def order_of(mappings: Sequence[Compared]) -> Order:
    """Return how well the predictions order the mappings, chain by chain."""
    agreements = [sign for one in _chains(mappings) for sign in _agreements(mappings, one)]
    if not agreements:
        return Order(0, None)
    return Order(len(agreements), sum(agreements) / len(agreements))


def _chains(mappings: Sequence[Compared]) -> list[str]:
    return sorted(set().union(*map(_common, mappings))) if mappings else []


def _agreements(mappings: Sequence[Compared], name: str) -> Iterator[int]:
    """Yield 1 for each pair that is predicted in the measured order, and -1 for each other."""
    known = [one for one in mappings if name in _common(one)]
    for one, other in combinations(known, 2):
        these, those = _p50s(one.runs, name), _p50s(other.runs, name)
        if max(these) < min(those) or max(those) < min(these):
            is_faster = max(these) < min(those)
            predicted = one.predicted.chains[name].p50_us < other.predicted.chains[name].p50_us
            yield 1 if is_faster == predicted else -1
