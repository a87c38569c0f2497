# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""The best mappings by their weights, found by CP-SAT."""

from __future__ import annotations

from collections import defaultdict
from collections.abc import Callable, Iterator
from dataclasses import dataclass
from typing import TYPE_CHECKING

from rmw_manycore_py.advice.annealing import annealed
from rmw_manycore_py.advice.model import Model
from rmw_manycore_py.advice.problem import Clusters, Problem
from rmw_manycore_py.advice.weights import EMPHASES, Emphasis, Objective, Weights

if TYPE_CHECKING:
    from ortools.sat.python.cp_model import CpSolver

_Groups = frozenset[frozenset[int]]
# Workers that take turns: the result does not depend on the machine's CPUs.
_WORKERS = 8
# Deterministic time per second of the two CPUs that benches use.
_WORK_PER_S = 0.2


@dataclass(frozen=True)
class Effort:
    """How much is searched.

    :param candidates: mappings that are compared.
    :param seconds: to search for all of them, counted as work, whose amount does not vary.
    """

    candidates: int = 8
    seconds: float = 20.0
    seed: int = 0

    def solver(self, seconds: float) -> CpSolver:
        """Return a solver whose result depends on the problem and the seed alone."""
        from ortools.sat.python.cp_model import CpSolver

        solver = CpSolver()
        solver.parameters.random_seed = self.seed
        solver.parameters.num_workers = _WORKERS
        solver.parameters.interleave_search = True
        solver.parameters.max_deterministic_time = seconds * _WORK_PER_S
        return solver


@dataclass(frozen=True)
class Found:
    """A mapping, what it was searched for, and whether no better one exists for that."""

    clusters: Clusters
    emphasis: Emphasis
    cost: int
    is_best: bool


def candidates(
    problem: Problem,
    objective: Objective,
    effort: Effort,
    report: Callable[[str], None] = lambda _: None,
) -> Iterator[Found]:
    """Yield the best mappings for each emphasis in turn; none if no mapping is feasible."""
    emphases = EMPHASES[objective]
    rounds = max(effort.candidates // len(emphases), 1)
    seconds = effort.seconds / (rounds * len(emphases))
    for emphasis in emphases:
        weights = Weights.of(problem, emphasis)
        model = Model(problem)
        model.hold(model.limits)
        model.minimise(weights)
        known: set[_Groups] = set()
        for number in range(rounds):
            report(f"{emphasis.name}, mapping {number + 1} of {rounds}")
            begin = annealed(problem, weights, effort.seed + number)
            # With a hint that is infeasible, CP-SAT 9.15 aborts if the problem is, too.
            is_feasible = not [*problem.broken(begin)] and _groups(begin) not in known
            model.hint(begin if is_feasible else None)
            found = _solved(model, weights, emphasis, effort.solver(seconds))
            if found is None and not known:
                return
            if found is None:
                break
            yield found
            known.add(_groups(found.clusters))
            model.exclude(found.clusters)


def _groups(clusters: Clusters) -> _Groups:
    """Return which units are together, whatever the numbers of their clusters."""
    members: dict[int, set[int]] = defaultdict(set)
    for unit, cluster in enumerate(clusters):
        members[cluster].add(unit)
    return frozenset(map(frozenset, members.values()))


def _solved(model: Model, weights: Weights, emphasis: Emphasis, solver: CpSolver) -> Found | None:
    from ortools.sat.python import cp_model

    status = solver.solve(model.cp)
    if status not in (cp_model.OPTIMAL, cp_model.FEASIBLE):
        return None
    clusters = model.mapping(solver)
    return Found(
        clusters, emphasis, weights.cost(model.problem, clusters), status == cp_model.OPTIMAL
    )
