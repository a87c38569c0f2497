# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""The figures of a report, and the limits they are compared with."""

from __future__ import annotations

import math

import pytest

from rmw_manycore_py.bench.summary import Goal, Result, Summary, judge, nearest_rank

pytestmark = pytest.mark.unit


def times(contender: str, *samples: float) -> Result:
    return Result("question", contender, "us", samples)


def rates(contender: str, *samples: float) -> Result:
    return Result("question", contender, "1/s", samples, higher_is_better=True)


def test_summary_does_not_depend_on_the_order_of_the_samples() -> None:
    assert Summary.of([9, 1, 2, 4]) == Summary(samples=4, median=3, mean=4, p99=9, largest=9)


@pytest.mark.parametrize(
    ("count", "rank"), [(1, 1), (99, 99), (100, 99), (101, 100), (200, 198), (1000, 990)]
)
def test_p99_is_the_nearest_rank(count: int, rank: int) -> None:
    assert nearest_rank(range(1, count + 1), 0.99) == rank


def test_one_sample_is_its_own_median_and_p99() -> None:
    assert Summary.of([7]) == Summary(samples=1, median=7, mean=7, p99=7, largest=7)


@pytest.mark.parametrize(("own", "reached"), [(12.0, True), (12.1, False)])
def test_within_a_factor_of_a_peer(own: float, reached: bool) -> None:
    goal = Goal("question", "own", "within", 1.2, "peer")
    (verdict,) = judge([times("own", own), times("peer", 10.0)], [goal])
    assert verdict.found == pytest.approx(own / 10)
    assert verdict.reached is reached


def test_a_time_is_better_when_it_is_shorter() -> None:
    goal = Goal("question", "own", "better", 2, "peer")
    (verdict,) = judge([times("own", 10), times("peer", 30)], [goal])
    assert verdict.found == 3
    assert verdict.reached


def test_a_rate_is_better_when_it_is_higher() -> None:
    goal = Goal("question", "own", "better", 2, "peer")
    (verdict,) = judge([rates("own", 10), rates("peer", 30)], [goal])
    assert verdict.found == pytest.approx(1 / 3)
    assert not verdict.reached


def test_a_goal_names_its_statistic() -> None:
    results = [times("own", 1, 1, 1), times("peer", 1, 1, 28)]
    goals = [
        Goal("question", "own", "better", 10, "peer"),
        Goal("question", "own", "better", 10, "peer", "mean"),
    ]
    assert [verdict.found for verdict in judge(results, goals)] == [1, 10]


def test_a_goal_without_a_peer_is_in_the_unit_of_the_samples() -> None:
    (verdict,) = judge([times("own", 4.0)], [Goal("question", "own", "within", 5)])
    assert verdict.found == 4
    assert verdict.reached


def test_a_goal_is_silent_when_one_side_was_not_measured() -> None:
    goals = [
        Goal("question", "own", "within", 1.2, "peer"),
        Goal("another question", "own", "within", 5),
    ]
    assert judge([times("own", 1)], goals) == []


def test_nothing_against_nothing_is_equal_and_against_something_infinite() -> None:
    goal = Goal("question", "own", "within", 1, "peer")
    (equal,) = judge([times("own", 0), times("peer", 0)], [goal])
    (infinite,) = judge([times("own", 1), times("peer", 0)], [goal])
    assert equal.reached
    assert infinite.found == math.inf
