# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""Decides which topic moves to another lane. Loads are fractions of a CPU."""

from __future__ import annotations

from collections.abc import Collection, Sequence
from dataclasses import dataclass

MIN_DIFFERENCE = 0.005  # smaller differences between lanes are ignored
MIN_GAIN = 0.3  # minimum gain of a move, as a fraction of the difference
PATIENCE = 3  # consecutive proposals of the same pair of lanes


@dataclass(frozen=True)
class Load:
    """Load of one topic."""

    lane: int
    load: float
    movable: bool = True


@dataclass(frozen=True)
class Move:
    """Move of a topic, given by its index among the loads, to another lane."""

    index: int
    heir: int


def best_move(loads: Sequence[Load], lanes: Collection[int]) -> Move | None:
    """Return the move that best evens out the busiest and the idlest lane, or None.

    Only running `lanes` are candidates.
    """
    totals = {lane: sum(e.load for e in loads if e.lane == lane) for lane in sorted(lanes)}
    if not totals:
        return None
    busiest, idlest = max(totals, key=totals.__getitem__), min(totals, key=totals.__getitem__)
    difference = totals[busiest] - totals[idlest]
    left = {
        index: abs(difference - 2 * entry.load)
        for index, entry in enumerate(loads)
        if entry.lane == busiest and entry.movable
    }
    if difference < MIN_DIFFERENCE or not left:
        return None
    index = min(left, key=left.__getitem__)
    return Move(index, idlest) if left[index] <= (1 - MIN_GAIN) * difference else None


class Balance:
    """Proposes a move only after it has been worthwhile several times in a row."""

    def __init__(self) -> None:
        self._times = 0
        self._lanes: tuple[int, int] | None = None

    def propose(self, loads: Sequence[Load], lanes: Collection[int]) -> Move | None:
        """Return a move to make now, or None."""
        move = best_move(loads, lanes)
        between = None if move is None else (loads[move.index].lane, move.heir)
        self._times = self._times + 1 if between == self._lanes else 1
        self._lanes = between
        if move is None or self._times < PATIENCE:
            return None
        self._lanes = None
        return move
