# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""The problem for CP-SAT: one variable per unit and cluster.

Each limit has a literal. It is true in a search for mappings; a search for the cause of a conflict
assumes it, or makes it cost something.
"""

from __future__ import annotations

from collections import defaultdict
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from itertools import pairwise
from typing import TYPE_CHECKING

from rmw_manycore_py.advice.problem import Clusters, Constraint, Flow, Problem
from rmw_manycore_py.advice.weights import Weights

if TYPE_CHECKING:
    from ortools.sat.python.cp_model import CpModel, CpSolver, IntVar, LinearExprT, LiteralT

MEMORY, CORES = "memory", "cores"


@dataclass(frozen=True)
class Limit:
    """A limit that may be part of a conflict: a wish, or the size of the clusters."""

    name: str
    literal: IntVar
    constraint: Constraint | None = None


@dataclass(frozen=True)
class Slack:
    """Room that each cluster is given in addition."""

    size_bytes: LinearExprT = 0
    cores: LinearExprT = 0


class Model:
    """Variables and limits of a problem; add an objective, then solve."""

    def __init__(self, problem: Problem, slack: Callable[[CpModel], Slack] | None = None) -> None:
        from ortools.sat.python.cp_model import CpModel

        self.problem = problem
        self.cp = CpModel()
        self.slack = slack(self.cp) if slack else Slack()
        self._numbers = [room.cluster for room in problem.rooms]
        self.places = [
            {number: self.cp.new_bool_var(f"{unit.name} in {number}") for number in self._numbers}
            for unit in problem.units
        ]
        for unit, places in zip(problem.units, self.places, strict=True):
            self.cp.add_exactly_one(places.values())
            if unit.is_bridge:
                self.cp.add(places[unit.cluster] == 1)
        self._crossings = [self._crossing(flow) for flow in problem.flows]
        self.limits = [*map(self._wish, problem.constraints), self._memory(), self._cores()]

    def hold(self, limits: Sequence[Limit]) -> None:
        """Require limits."""
        for limit in limits:
            self.cp.add(limit.literal == 1)

    def minimise(self, weights: Weights) -> None:
        """Set the objective."""
        problem = self.problem
        fullest = self.cp.new_int_var(0, sum(weights.load), "load of the fullest cluster")
        for number in self._numbers:
            pairs = zip(weights.load, self.places, strict=True)
            self.cp.add(fullest >= sum(weight * places[number] for weight, places in pairs))
        moved = (
            1 - places[unit.cluster]
            for unit, places in zip(problem.units, self.places, strict=True)
        )
        self.cp.minimize(
            sum(
                weight * crossing
                for weight, crossings in zip(weights.crossing, self._crossings, strict=True)
                for crossing in crossings.values()
            )
            + fullest
            + sum(moved)
        )

    def hint(self, clusters: Clusters | None) -> None:
        """Begin the search at a mapping, or anywhere."""
        self.cp.clear_hints()  # type: ignore[no-untyped-call]
        for places, cluster in zip(self.places, clusters or (), strict=clusters is not None):
            for number, place in places.items():
                self.cp.add_hint(place, number == cluster)

    def exclude(self, clusters: Clusters) -> None:
        """Require a mapping that puts other units together than this one."""
        groups: dict[int, list[int]] = defaultdict(list)
        for unit, cluster in enumerate(clusters):
            groups[cluster].append(unit)
        # Chains of equal places hold a group together; one has to break, or two groups to merge.
        changed: list[LiteralT] = [
            self._differ(a, b) for own in groups.values() for a, b in pairwise(own)
        ]
        firsts = [own[0] for own in groups.values()]
        changed += [
            self._differ(a, b).negated() for n, a in enumerate(firsts) for b in firsts[n + 1 :]
        ]
        self.cp.add_bool_or(changed)

    def mapping(self, solver: CpSolver) -> Clusters:
        """Return the mapping that was found."""
        return tuple(
            next(number for number, place in places.items() if solver.boolean_value(place))
            for places in self.places
        )

    def _crossing(self, flow: Flow) -> dict[int, IntVar]:
        """Return by cluster whether a flow crosses to it."""
        found = {}
        publisher = self.places[flow.publisher]
        for number in self._numbers:
            crosses = self.cp.new_bool_var(f"{flow.topic} to {number}")
            for receiver in flow.receivers:
                there = self.places[receiver][number]
                self.cp.add_bool_or(there.negated(), publisher[number], crosses)
            found[number] = crosses
        return found

    def _differ(self, first: int, second: int) -> IntVar:
        """Return a literal for two units in different clusters."""
        differ = self.cp.new_bool_var("")
        for number in self._numbers:
            a, b = self.places[first][number], self.places[second][number]
            self.cp.add_bool_or(a.negated(), b, differ)
            self.cp.add_bool_or(a.negated(), b.negated(), differ.negated())
        return differ

    def _limit(self, name: str, constraint: Constraint | None = None) -> Limit:
        return Limit(name, self.cp.new_bool_var(name), constraint)

    def _wish(self, wish: Constraint) -> Limit:
        limit = self._limit(wish.text, wish)
        own = [(self.places[unit], self.problem.units[unit].cluster) for unit in wish.units]
        for number in self._numbers:
            here = [places[number] for places, _ in own]
            if wish.kind == "apart":
                self.cp.add(sum(here) <= 1).only_enforce_if(limit.literal)
            elif wish.kind == "together":
                for a, b in pairwise(here):
                    self.cp.add(a == b).only_enforce_if(limit.literal)
        if wish.kind == "fix":
            for places, cluster in own:
                self.cp.add_implication(limit.literal, places[cluster])
        return limit

    def _memory(self) -> Limit:
        limit = self._limit(MEMORY)
        for room in self.problem.rooms:
            used = [
                unit.size_bytes * places[room.cluster]
                for unit, places in zip(self.problem.units, self.places, strict=True)
                if unit.size_bytes
            ]
            used += [
                flow.landing_bytes * crossings[room.cluster]
                for flow, crossings in zip(self.problem.flows, self._crossings, strict=True)
                if flow.landing_bytes
            ]
            has_room = self.cp.add(sum(used) <= room.size_bytes + self.slack.size_bytes)
            has_room.only_enforce_if(limit.literal)
        return limit

    def _cores(self) -> Limit:
        limit = self._limit(CORES)
        needs = [self.problem.needed_cores(unit) for unit in range(len(self.problem.units))]
        for room in self.problem.rooms:
            used = (
                need * places[room.cluster]
                for need, places in zip(needs, self.places, strict=True)
                if need
            )
            has_room = self.cp.add(sum(used) <= len(room.cores) + self.slack.cores)
            has_room.only_enforce_if(limit.literal)
        return limit
