# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""Lost messages and missed deadlines, as events."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass

import numpy as np

from rmw_manycore_py.platform.monitor.events import Event
from rmw_manycore_py.platform.monitor.graph import Endpoint
from rmw_manycore_py.platform.monitor.loads import Loads
from rmw_manycore_py.platform.monitor.sample import DEADLINES, DROPPED, EXPIRED, LOST, REFUSED

SUM_S = 10.0  # reporting period of continuing losses
_WORDS = {LOST: "lost", EXPIRED: "expired", REFUSED: "refused", DROPPED: "dropped"}
_COLUMNS = (*_WORDS, DEADLINES)
_Key = tuple[int, int]  # id of an endpoint, column


@dataclass
class _Loss:
    """Losses of one kind at one endpoint, since the last report."""

    endpoint: Endpoint
    count: int = 0
    reported_s: float | None = None


class Losses:
    """Reports the first loss of a kind at an endpoint at once, then sums while it continues."""

    def __init__(self) -> None:
        self._known: dict[_Key, _Loss] = {}

    def events_of(self, loads: Loads) -> Iterator[Event]:
        """Yield the events due after these two samples."""
        for row, index in np.argwhere(loads.changes[:, _COLUMNS] > 0):
            endpoint, column = loads.graph.endpoints[row], _COLUMNS[index]
            loss = self._known.setdefault((endpoint.id, column), _Loss(endpoint))
            loss.count += int(loads.changes[row, column])
        now_s = loads.after.time_s
        for (endpoint_id, column), loss in list(self._known.items()):
            if loss.reported_s is not None and now_s - loss.reported_s < SUM_S:
                continue
            if loss.count:
                yield _event_of(loss, column, now_s)
                loss.count, loss.reported_s = 0, now_s
            else:
                del self._known[endpoint_id, column]

    def rest(self, now_s: float) -> Iterator[Event]:
        """Yield unreported losses, at the end of the platform."""
        for (_, column), loss in self._known.items():
            if loss.count:
                yield _event_of(loss, column, now_s)


def _event_of(loss: _Loss, column: int, now_s: float) -> Event:
    endpoint, count = loss.endpoint, loss.count
    span = "" if loss.reported_s is None else f" in {now_s - loss.reported_s:.0f} s"
    if column == DEADLINES:
        times = "" if count == 1 else f" {count} times"
        text = f"{endpoint.topic}: {endpoint.node} missed its deadline{times}{span}"
        return Event("deadline", text, endpoint.node, endpoint.topic)
    text = f"{endpoint.topic}: {count} {_WORDS[column]} by {endpoint.node}{span}"
    return Event("lost", text, endpoint.node, endpoint.topic)
