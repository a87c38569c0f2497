# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""Selection of the topic that moves, and of its lane."""

from __future__ import annotations

from rmw_manycore_bridge.balance import PATIENCE, Balance, Load, Move, best_move


def test_two_heavy_topics_part() -> None:
    loads = [Load(0, 0.3), Load(1, 0.01), Load(0, 0.2), Load(1, 0.01)]
    assert best_move(loads, {0, 1}) in (Move(0, 1), Move(2, 1))


def test_a_topic_as_heavy_as_its_lane_stays() -> None:
    assert best_move([Load(0, 0.6), Load(0, 0.01), Load(1, 0.01)], {0, 1}) is None


def test_small_differences_are_left_alone() -> None:
    assert best_move([Load(0, 0.002), Load(0, 0.002), Load(1, 0.0)], {0, 1}) is None


def test_what_may_not_move_stays() -> None:
    loads = [Load(0, 0.3, movable=False), Load(0, 0.2), Load(1, 0.0)]
    assert best_move(loads, {0, 1}) == Move(1, 1)


def test_the_idlest_of_several_lanes_inherits() -> None:
    loads = [Load(0, 0.3), Load(0, 0.3), Load(1, 0.2), Load(2, 0.1)]
    move = best_move(loads, {0, 1, 2})
    assert move is not None
    assert move.heir == 2


def test_a_lane_that_does_not_run_inherits_nothing() -> None:
    loads = [Load(0, 0.3), Load(0, 0.3), Load(1, 0.0), Load(2, 0.1)]
    move = best_move(loads, {0, 2})
    assert move is not None
    assert move.heir == 2
    assert best_move(loads, set()) is None


def test_moves_end_when_nothing_gets_better() -> None:
    loads = [Load(0, 0.1 * n) for n in range(1, 8)]
    for _ in range(20):
        move = best_move(loads, {0, 1, 2})
        if move is None:
            break
        loads[move.index] = Load(move.heir, loads[move.index].load)
    assert best_move(loads, {0, 1, 2}) is None


def test_a_passing_difference_moves_nothing() -> None:
    uneven, even = [Load(0, 0.3), Load(0, 0.3), Load(1, 0.0)], [Load(0, 0.3), Load(1, 0.3)]
    balance = Balance()
    for _ in range(PATIENCE - 1):
        assert balance.propose(uneven, {0, 1}) is None
    assert balance.propose(even, {0, 1}) is None
    moves = [balance.propose(uneven, {0, 1}) for _ in range(PATIENCE)]
    assert [move is not None for move in moves] == [False] * (PATIENCE - 1) + [True]


def test_a_difference_that_goes_to_and_fro_moves_nothing() -> None:
    left, right = [Load(0, 0.3), Load(0, 0.3), Load(1, 0.0)], [Load(1, 0.3), Load(1, 0.3)]
    balance = Balance()
    for loads in [left, right] * PATIENCE:
        assert balance.propose(loads, {0, 1}) is None
