# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""The routes of a bridge, as its processes are told them on their command line."""

from __future__ import annotations

import json
from dataclasses import asdict, dataclass

from rmw_manycore_py.routes import Direction, Route


@dataclass(frozen=True)
class Plan:
    """All routes of a platform's bridge. Lanes are pairs of processes, counted from 0."""

    platform: str
    routes: tuple[Route, ...]

    def of(self, direction: Direction, lane: int) -> tuple[Route, ...]:
        """Return the routes that one process begins with."""
        return tuple(r for r in self.routes if r.direction == direction and r.lane == lane)

    def lanes(self, direction: Direction) -> int:
        """Return how many lanes have something to carry."""
        return 1 + max((r.lane for r in self.routes if r.direction == direction), default=-1)

    def topics(self, direction: Direction) -> tuple[Route, ...]:
        """Return the topics of all lanes; they may move from one to another."""
        return tuple(r for r in self._topics(direction) if not r.is_pattern)

    def patterns(self, direction: Direction) -> tuple[Route, ...]:
        """Return what stands for several topics; those stay in the lane of their pattern."""
        return tuple(r for r in self._topics(direction) if r.is_pattern)

    def _topics(self, direction: Direction) -> tuple[Route, ...]:
        return tuple(r for r in self.routes if (r.kind, r.direction) == ("topic", direction))

    def to_json(self) -> str:
        """Return the plan as one word of a command line."""
        return json.dumps(asdict(self))

    @classmethod
    def from_json(cls, text: str) -> Plan:
        """Return what `to_json` wrote."""
        data = json.loads(text)
        routes = tuple(Route(**route) for route in data.pop("routes"))
        return cls(routes=routes, **data)
