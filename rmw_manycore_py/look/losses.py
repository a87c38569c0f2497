# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""Messages lost and deadlines missed, as events."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass

import numpy as np

from rmw_manycore_py.look.graph import Endpoint
from rmw_manycore_py.look.happenings import Happening
from rmw_manycore_py.look.loads import Loads
from rmw_manycore_py.look.sample import DEADLINES, EXPIRED, LOST, REFUSED

SUM_S = 10.0  # what goes on is told so often: two lines a second would hide all else
_WORDS = {LOST: "lost", EXPIRED: "expired", REFUSED: "refused"}
_COLUMNS = (*_WORDS, DEADLINES)
_Key = tuple[int, int]  # id of an endpoint, column


@dataclass
class _Loss:
    """Of one kind at one endpoint, since it was told last."""

    endpoint: Endpoint
    count: int = 0
    told_s: float | None = None


class Losses:
    """Tells the first of a kind at an endpoint at once; then sums, as long as it goes on."""

    def __init__(self) -> None:
        self._known: dict[_Key, _Loss] = {}

    def told_of(self, loads: Loads) -> Iterator[Happening]:
        """Yield what is to be told after these two samples."""
        for row, index in np.argwhere(loads.changes[:, _COLUMNS] > 0):
            endpoint, column = loads.graph.endpoints[row], _COLUMNS[index]
            loss = self._known.setdefault((endpoint.id, column), _Loss(endpoint))
            loss.count += int(loads.changes[row, column])
        now_s = loads.after.time_s
        for (endpoint_id, column), loss in list(self._known.items()):
            if loss.told_s is not None and now_s - loss.told_s < SUM_S:
                continue
            if loss.count:
                yield _told(loss, column, now_s)
                loss.count, loss.told_s = 0, now_s
            else:
                del self._known[endpoint_id, column]

    def rest(self, now_s: float) -> Iterator[Happening]:
        """Yield what was not told yet, at the end of the platform."""
        for (_, column), loss in self._known.items():
            if loss.count:
                yield _told(loss, column, now_s)


def _told(loss: _Loss, column: int, now_s: float) -> Happening:
    endpoint, count = loss.endpoint, loss.count
    span = "" if loss.told_s is None else f" in {now_s - loss.told_s:.0f} s"
    if column == DEADLINES:
        times = "" if count == 1 else f" {count} times"
        text = f"{endpoint.topic}: {endpoint.node} missed its deadline{times}{span}"
        return Happening("deadline", text, endpoint.node, endpoint.topic)
    text = f"{endpoint.topic}: {count} {_WORDS[column]} by {endpoint.node}{span}"
    return Happening("lost", text, endpoint.node, endpoint.topic)
