# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""A good mapping to begin with, by simulated annealing.

From a poor one, CP-SAT needs minutes to get as far with 226 nodes on five clusters.
"""

from __future__ import annotations

import math
import random
from collections import Counter, defaultdict

from rmw_manycore_py.advice.problem import Clusters, Problem
from rmw_manycore_py.advice.weights import Weights

_STEPS_PER_UNIT = 300
_MAX_STEPS = 60_000
_FIRST_SHARE, _LAST_SHARE = 1e-3, 1e-6  # temperatures, of the largest possible cost
_BROKEN = 10.0  # of that cost: of a wish, a missing core, the size of a cluster


def annealed(problem: Problem, weights: Weights, seed: int) -> Clusters:
    """Return the best mapping that was met, which may break limits where they are tight."""
    search = _Search(problem, weights)
    return search.run(random.Random(seed))


class _Search:
    def __init__(self, problem: Problem, weights: Weights) -> None:
        self._problem = problem
        self._weights = weights
        self._clusters = list(problem.now)
        self._numbers = [room.cluster for room in problem.rooms]
        self._free = [i for i in range(len(problem.units)) if i not in problem.fixed]
        self._needs = [problem.needed_cores(i) for i in range(len(problem.units))]
        self._ends: dict[int, list[int]] = defaultdict(list)
        self._receivers: list[Counter[int]] = []
        for index, flow in enumerate(problem.flows):
            for unit in {flow.publisher, *flow.receivers}:
                self._ends[unit].append(index)
            self._receivers.append(Counter(self._clusters[one] for one in flow.receivers))
        self._wishes: dict[int, list[int]] = defaultdict(list)
        for index, wish in enumerate(problem.constraints):
            for unit in wish.units:
                self._wishes[unit].append(index)
        self._load = self._totals(weights.load)
        self._cores = self._totals(self._needs)
        self._size = self._totals([unit.size_bytes for unit in problem.units])
        crossings = (
            weight * (len(self._numbers) - 1)
            for weight, flow in zip(weights.crossing, problem.flows, strict=True)
        )
        self._whole = sum(crossings) + sum(weights.load) + 1

    def run(self, chance: random.Random) -> Clusters:
        steps = min(_STEPS_PER_UNIT * len(self._free), _MAX_STEPS)
        best, best_cost, cost = tuple(self._clusters), 0.0, 0.0
        for step in range(steps if len(self._numbers) > 1 else 0):
            heat = _FIRST_SHARE * (_LAST_SHARE / _FIRST_SHARE) ** (step / steps) * self._whole
            unit = chance.choice(self._free)
            here = self._clusters[unit]
            there = chance.choice(self._numbers)
            if there == here:
                continue
            before = self._local(unit, here, there)
            self._move(unit, there)
            change = self._local(unit, here, there) - before
            if change <= 0 or chance.random() < math.exp(-change / heat):
                cost += change
                if cost < best_cost:
                    best, best_cost = tuple(self._clusters), cost
            else:
                self._move(unit, here)
        return best

    def _totals(self, values: list[int] | tuple[int, ...]) -> dict[int, int]:
        totals = dict.fromkeys(self._numbers, 0)
        for value, cluster in zip(values, self._clusters, strict=True):
            totals[cluster] += value
        return totals

    def _move(self, unit: int, there: int) -> None:
        here = self._clusters[unit]
        self._clusters[unit] = there
        for index in self._ends[unit]:
            if unit in self._problem.flows[index].receivers:
                self._receivers[index][here] -= 1
                self._receivers[index][there] += 1
        for totals, value in (
            (self._load, self._weights.load[unit]),
            (self._cores, self._needs[unit]),
            (self._size, self._problem.units[unit].size_bytes),
        ):
            totals[here] -= value
            totals[there] += value

    def _local(self, unit: int, *clusters: int) -> float:
        """Return the part of the cost that a move of a unit between clusters can change."""
        crossing = 0
        for index in self._ends[unit]:
            own = self._clusters[self._problem.flows[index].publisher]
            others = sum(1 for one, n in self._receivers[index].items() if n and one != own)
            crossing += self._weights.crossing[index] * others
        moved = self._clusters[unit] != self._problem.units[unit].cluster
        wishes = (self._problem.constraints[index] for index in self._wishes[unit])
        now = tuple(self._clusters) if self._wishes[unit] else ()
        broken = float(sum(not wish.holds(self._problem, now) for wish in wishes))
        for cluster in clusters:
            room = self._problem.room(cluster)
            broken += max(self._cores[cluster] - len(room.cores), 0)
            broken += max(self._size[cluster] / room.size_bytes - 1, 0)
        return crossing + max(self._load.values()) + moved + _BROKEN * self._whole * broken
