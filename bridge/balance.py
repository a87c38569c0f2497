# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""Decides which topic moves to another lane. Loads are shares of a CPU."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

LEAST_DIFFERENCE = 0.02  # below it no move is worth its while
LEAST_GAIN = 0.3  # of the difference between the lanes
PATIENCE = 3  # looks in a row that want a move


@dataclass(frozen=True)
class Load:
    """A topic as the balance sees it."""

    lane: int
    load: float
    movable: bool = True


@dataclass(frozen=True)
class Move:
    """A topic, by its place among the loads, that goes to another lane."""

    index: int
    heir: int


def best_move(loads: Sequence[Load], lanes: int) -> Move | None:
    """Return the move that evens out the busiest and the idlest lane best, if one is worth it."""
    totals = [sum(entry.load for entry in loads if entry.lane == lane) for lane in range(lanes)]
    busiest, idlest = totals.index(max(totals)), totals.index(min(totals))
    difference = totals[busiest] - totals[idlest]
    left = {
        index: abs(difference - 2 * entry.load)
        for index, entry in enumerate(loads)
        if entry.lane == busiest and entry.movable
    }
    if difference < LEAST_DIFFERENCE or not left:
        return None
    index = min(left, key=left.__getitem__)
    return Move(index, idlest) if left[index] <= (1 - LEAST_GAIN) * difference else None


class Balance:
    """Moves only when a move has been worth it for a while."""

    def __init__(self, lanes: int) -> None:
        self._lanes = lanes
        self._times = 0

    def look(self, loads: Sequence[Load]) -> Move | None:
        """Return a move to make now."""
        move = best_move(loads, self._lanes)
        self._times = self._times + 1 if move is not None else 0
        if self._times < PATIENCE:
            return None
        self._times = 0
        return move
