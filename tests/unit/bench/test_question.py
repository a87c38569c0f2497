# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""Contenders take turns; the names given with --only select among them."""

from __future__ import annotations

from collections.abc import Callable

import pytest

from rmw_manycore_py.bench import (
    fan_out,
    first_message,
    idle,
    rclpy_round_trip,
    round_trip,
    scale,
    startup,
    steady_state,
    throughput,
)
from rmw_manycore_py.bench.question import Run
from rmw_manycore_py.bench.scale.common import QUICK_SHARE, along, on_curve
from rmw_manycore_py.bench.summary import Result
from rmw_manycore_py.errors import ManycoreError

pytestmark = pytest.mark.unit

QUESTIONS = [
    module.QUESTION
    for module in (
        fan_out,
        first_message,
        rclpy_round_trip,
        round_trip,
        scale,
        startup,
        steady_state,
        throughput,
    )
] + [idle.question(3)]


def counting(order: list[str], name: str) -> Callable[[], list[float]]:
    def measure() -> list[float]:
        order.append(name)
        return [float(len(order))]

    return measure


def test_contenders_take_turns() -> None:
    order: list[str] = []
    contenders = {name: counting(order, name) for name in ("a", "b")}
    results = Run(cpus=(0, 1), rounds=3).interleave("question", "us", contenders)
    assert order == ["a", "b"] * 3
    assert [result.samples for result in results] == [(1, 3, 5), (2, 4, 6)]


def test_only_the_chosen_take_part() -> None:
    order: list[str] = []
    contenders = {name: counting(order, name) for name in ("futex", "Fast DDS", "manycore")}
    run = Run(cpus=(0, 1), rounds=1, only=("futex", "DDS"))
    assert [r.contender for r in run.interleave("q", "us", contenders)] == ["futex", "Fast DDS"]


def failing() -> list[float]:
    raise ManycoreError("no answer")


def test_a_contender_that_fails_costs_no_other_its_figures() -> None:
    order: list[str] = []
    run = Run(cpus=(0, 1), rounds=2)
    contenders = {"peer": failing, "own": counting(order, "own")}
    results = run.interleave("trip", "us", contenders)
    assert [(result.contender, result.samples) for result in results] == [("own", (1, 2))]
    assert run.failures == ["trip: peer: no answer"]


def test_a_curve_ends_where_its_contender_fails() -> None:
    def measure(count: int) -> list[Result]:
        if count > 2:
            failing()
        return [on_curve("trip", "peer", count, "nodes", "us", [1.0])]

    run = Run(cpus=(0, 1))
    results = along(run, "trip: peer", (1, 2, 4, 8), "nodes", measure)
    assert [result.contender for result in results] == ["peer, 1 nodes", "peer, 2 nodes"]
    assert run.failures == ["trip: peer, 4 nodes: no answer"]


def test_a_quick_run_measures_half_of_a_curve_or_as_many_points_as_it_needs() -> None:
    def measured(*places: int, fewest: int) -> list[int]:
        found: list[int] = []

        def measure(count: int) -> list[Result]:
            found.append(count)
            return []

        along(Run(cpus=(0, 1), share=QUICK_SHARE), "peer", places, "nodes", measure, fewest)
        return found

    assert measured(1, 2, 4, 8, fewest=1) == [1, 2]
    assert measured(1, 2, 4, fewest=2) == [1, 2]
    assert measured(1, fewest=2) == [1]


def test_only_some_questions_are_put_to_a_contender() -> None:
    contenders = {name: counting([], name) for name in ("futex", "Fast DDS")}
    run = Run(cpus=(0, 1), rounds=1, only=("64 B: fu",))
    assert [r.contender for r in run.interleave("trip 64 B", "us", contenders)] == ["futex"]
    assert run.interleave("trip 1 KiB", "us", contenders) == []


def test_a_share_of_the_iterations_is_never_none() -> None:
    run = Run(cpus=(0, 1), share=0.05)
    assert [run.iterations(full) for full in (2000, 10)] == [100, 4]


@pytest.mark.parametrize("question", QUESTIONS, ids=lambda question: question.name)
def test_goals_are_different_from_each_other(question: round_trip.Question) -> None:
    assert question.goals
    assert len(set(question.goals)) == len(question.goals)
