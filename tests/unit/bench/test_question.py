# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""Contenders take turns; the names that --only gives choose among them."""

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
