# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""A process as one of several lanes: follows the lane table; lane 0 balances the loads."""

from __future__ import annotations

import sys
import time
from collections.abc import Mapping, Sequence

from rmw_manycore_bridge.balance import Balance, Load, Move
from rmw_manycore_bridge.lanes import LaneTable
from rmw_manycore_bridge.topic_role import TopicRole
from rmw_manycore_py.routes.plan import Plan
from rmw_manycore_py.routes.route import Direction

PERIOD_S = 0.1  # polling period of the lane table
BALANCE_S = 2.0  # polling period of the loads
MOVE_S = 10.0  # timeout of a move
REST_S = 60.0  # pause before a topic whose move failed may move again


class Lanes:
    """Used by the main thread. No-op and without a file if there is a single lane."""

    def __init__(self, plan: Plan, direction: Direction, lane: int) -> None:
        self._plan, self._direction, self._lane = plan, direction, lane
        self._stem = plan.outside.stem(direction)
        lanes = plan.lanes(direction)
        self.period_s = PERIOD_S if lanes > 1 else None
        self._table = LaneTable.of(plan.platform, self._stem) if lanes > 1 else None
        if self._table is not None:
            self._table.join(plan.topics(direction), lane)
        self._balance = Balance()
        self._move: Move | None = None
        self._rests_until_s: dict[int, float] = {}
        self._next_s = time.monotonic() + BALANCE_S
        self._give_up_s = 0.0

    def topic_role(self, index: int) -> TopicRole:
        """Return the role of this process for a topic, by the topic's index in the plan."""
        return TopicRole(self._table, index, self._lane)

    def poll(self) -> bool:
        """Start a move if worthwhile; return whether the topics of any lane have changed."""
        table = self._table
        if table is None:
            return False
        if self._lane == 0 and time.monotonic() >= self._next_s:
            self._next_s = time.monotonic() + BALANCE_S
            self._even_out(table)
        return table.has_changed()

    def _even_out(self, table: LaneTable) -> None:
        moving = [index for index, share in enumerate(table.shares) if share.heir is not None]
        if moving:
            if time.monotonic() > self._give_up_s:
                with table.change(moving[0]) as share:
                    share.heir = share.first = None
            return
        if self._move is not None:
            if table.shares[self._move.index].owner != self._move.heir:
                self._rests_until_s[self._move.index] = time.monotonic() + REST_S
            self._move = None
        from rmw_manycore_bridge.status import topic_loads  # not loaded with a single lane

        found = topic_loads(self._plan.platform, self._stem)
        move = self._balance.propose(self._loads(table, found), found)
        if move is not None:
            self._move = move
            self._give_up_s = time.monotonic() + MOVE_S
            self._begin(table, move)

    def _loads(
        self, table: LaneTable, found: Mapping[int, Sequence[tuple[float, bool]]]
    ) -> list[Load]:
        loads, now_s = [], time.monotonic()
        for index, share in enumerate(table.shares):
            of_owner = found.get(share.owner)
            load, movable = (0.0, False) if of_owner is None else of_owner[index]
            rests = now_s < self._rests_until_s.get(index, 0.0)
            loads.append(Load(share.owner, load, movable and not rests))
        return loads

    def _begin(self, table: LaneTable, move: Move) -> None:
        with table.change(move.index) as share:
            share.heir, share.first = move.heir, None
        name = self._plan.topics(self._direction)[move.index].inside
        print(f"{name}: moves to lane {move.heir}", file=sys.stderr, flush=True)
