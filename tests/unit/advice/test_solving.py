# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""Mappings that the solver finds, compared with all mappings there are."""

from __future__ import annotations

import itertools
import random
from dataclasses import replace

import pytest

from rmw_manycore_py.advice.annealing import annealed
from rmw_manycore_py.advice.conflict import conflict_in
from rmw_manycore_py.advice.model import CORES, MEMORY
from rmw_manycore_py.advice.problem import Clusters, Constraint, Flow, Problem, Room, Unit
from rmw_manycore_py.advice.solving import Effort, Found, candidates
from rmw_manycore_py.advice.weights import EMPHASES, OBJECTIVES, Objective, Weights

pytestmark = pytest.mark.unit

SEEDS = range(8)
EFFORT = Effort(candidates=4, seconds=40.0)


def drawn(seed: int) -> Problem:
    """Return a small problem with limits that bind."""
    chance = random.Random(seed)
    clusters = chance.choice((2, 3))
    count = chance.randint(4, 6)
    units = [
        Unit(f"n{i}", chance.randint(1, clusters), None, chance.random(), chance.randint(1, 50))
        for i in range(count)
    ]
    rooms = tuple(
        Room(number, tuple(range(1, 1 + chance.randint(2, count))), chance.randint(60, 200))
        for number in range(1, clusters + 1)
    )
    flows = [
        Flow(
            f"/t{i}",
            publisher := chance.randrange(count),
            frozenset(chance.sample(range(count), chance.randint(1, 3))) - {publisher},
            chance.randint(1, 100),
            chance.randint(0, 10_000),
            landing_bytes=chance.choice((0, 0, 20)),
            is_hot=chance.random() < 0.2,
        )
        for i in range(chance.randint(2, 7))
    ]
    wishes = [
        Constraint(kind, f"--{kind} {number}", tuple(chance.sample(range(count), number)))
        for kind, number in (("fix", 1), ("apart", 2), ("together", 2))
        if chance.random() < 0.4
    ]
    return Problem(tuple(units), rooms, tuple(one for one in flows if one.receivers), tuple(wishes))


def feasible(problem: Problem) -> list[Clusters]:
    numbers = [room.cluster for room in problem.rooms]
    every = itertools.product(numbers, repeat=len(problem.units))
    return [one for one in every if not [*problem.broken(one)]]


def groups(clusters: Clusters) -> frozenset[frozenset[int]]:
    return frozenset(
        frozenset(i for i, one in enumerate(clusters) if one == number) for number in set(clusters)
    )


def found(problem: Problem, objective: Objective, effort: Effort = EFFORT) -> list[Found]:
    return [*candidates(problem, objective, effort)]


@pytest.mark.parametrize("seed", SEEDS)
def test_no_mapping_is_better_than_the_best(seed: int) -> None:
    problem = drawn(seed)
    every = feasible(problem)
    objective = OBJECTIVES[seed % len(OBJECTIVES)]
    results = found(problem, objective)
    assert bool(results) == bool(every)
    for emphasis in EMPHASES[objective]:
        weights = Weights.of(problem, emphasis)
        own = [one for one in results if one.emphasis is emphasis]
        costs = {groups(one): 10**12 for one in every}
        for one in every:
            costs[groups(one)] = min(costs[groups(one)], weights.cost(problem, one))
        assert [one.cost for one in own] == sorted(costs.values())[: len(own)]
        assert all(one.is_best and one.clusters in every for one in own)


def test_some_problems_are_feasible_and_some_are_not() -> None:
    assert {bool(feasible(drawn(seed))) for seed in SEEDS} == {True, False}


@pytest.mark.parametrize("seed", SEEDS)
def test_annealing_comes_close(seed: int) -> None:
    problem = drawn(seed)
    flows = tuple(replace(one, landing_bytes=0) for one in problem.flows)  # it ignores them
    problem = replace(problem, constraints=(), flows=flows)
    every = feasible(problem)
    weights = Weights.of(problem, EMPHASES["p99"][0])
    if every:
        best = min(weights.cost(problem, one) for one in every)
        begin = annealed(problem, weights, 1)
        assert not [*problem.broken(begin)]
        assert weights.cost(problem, begin) <= 1.2 * best + 10


def test_the_same_seed_gives_the_same_mappings() -> None:
    problem = next(one for one in map(drawn, SEEDS) if feasible(one))
    assert found(problem, "p99") == found(problem, "p99")


def test_equal_mappings_leave_units_where_they_are() -> None:
    units = tuple(Unit(f"n{i}", cluster=2, load_cpus=0.1) for i in range(3))
    rooms = tuple(Room(number, (1, 2, 3, 4), 100) for number in (1, 2, 3))
    flows = (Flow("/a", 0, frozenset({1, 2}), 10.0, 100.0),)
    best = found(Problem(units, rooms, flows), "bytes")[0]
    assert best.clusters == (2, 2, 2)


UNITS = tuple(Unit(f"n{i}", cluster=1, size_bytes=30) for i in range(6))
ROOMS = tuple(Room(number, (1, 2, 3, 4), 100) for number in (1, 2))
FLOW = (Flow("/a", 0, frozenset({1}), 10.0),)
APART = Constraint("apart", "--apart n0,n1,n2", (0, 1, 2))
TOGETHER = Constraint("together", "--together n0,n1", (0, 1))


def test_wishes_that_contradict_each_other_are_named() -> None:
    pair = Constraint("apart", "--apart n0,n1", (0, 1))
    conflict = conflict_in(Problem(UNITS, ROOMS, FLOW, (TOGETHER, pair)), EFFORT)
    assert conflict is not None
    assert set(conflict.limits) == {TOGETHER.text, pair.text}
    assert set(conflict.dropped) == {TOGETHER.text, pair.text}
    assert (conflict.more_bytes, conflict.more_cores, conflict.all_of) == (None, None, ())


def test_a_wish_that_no_platform_grants_is_named() -> None:
    conflict = conflict_in(Problem(UNITS, ROOMS, FLOW, (APART, TOGETHER)), EFFORT)
    assert conflict is not None
    assert conflict.limits in ((APART.text,), (TOGETHER.text, APART.text))
    assert conflict.dropped == (APART.text,)


def test_missing_memory_is_measured() -> None:
    """Six units of 30 in two clusters of 80: three of them take 90."""
    rooms = tuple(replace(room, size_bytes=80) for room in ROOMS)
    conflict = conflict_in(Problem(UNITS, rooms, FLOW), EFFORT)
    assert conflict is not None
    assert (conflict.limits, conflict.more_bytes) == ((MEMORY,), 10)


def test_missing_cores_are_counted() -> None:
    rooms = tuple(replace(room, cores=(1, 2)) for room in ROOMS)
    conflict = conflict_in(Problem(UNITS, rooms, FLOW), EFFORT)
    assert conflict is not None
    assert (conflict.limits, conflict.more_cores) == ((CORES,), 1)
    assert conflict_in(Problem(UNITS, rooms, FLOW, shares_cores=True), EFFORT) is None


def test_of_several_conflicts_all_are_to_be_given_up() -> None:
    rooms = tuple(replace(room, size_bytes=80) for room in ROOMS)
    conflict = conflict_in(Problem(UNITS, rooms, FLOW, (APART,)), EFFORT)
    assert conflict is not None
    assert set(conflict.all_of) == {MEMORY, APART.text}
