# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""Routes of a bridge, passed to its processes on the command line."""

from __future__ import annotations

import json
from collections.abc import Iterator
from dataclasses import asdict, dataclass, field

from rmw_manycore_py.routes.outside import OutsideSettings
from rmw_manycore_py.routes.route import Direction, Route


@dataclass(frozen=True)
class Plan:
    """All routes of one bridge of a platform. Lanes are pairs of processes, numbered from 0."""

    platform: str
    routes: tuple[Route, ...]
    outside: OutsideSettings = field(default_factory=OutsideSettings)

    def of(self, direction: Direction, lane: int) -> tuple[Route, ...]:
        """Return the initial routes of one process."""
        return tuple(r for r in self.routes if r.direction == direction and r.lane == lane)

    def lanes(self, direction: Direction) -> int:
        """Return the number of lanes that have routes."""
        return 1 + max((r.lane for r in self.routes if r.direction == direction), default=-1)

    def topics(self, direction: Direction) -> tuple[Route, ...]:
        """Return the topics of all lanes; they may move between lanes."""
        return tuple(r for r in self._single(direction) if r.kind == "topic")

    def patterns(self, direction: Direction) -> tuple[Route, ...]:
        """Return the patterns; what fits one stays in its lane."""
        return tuple(r for r in self.routes if r.direction == direction and r.is_pattern)

    def services(self, direction: Direction) -> tuple[Route, ...]:
        """Return the services of all lanes."""
        return tuple(r for r in self._single(direction) if r.kind == "service")

    def _single(self, direction: Direction) -> Iterator[Route]:
        return (r for r in self.routes if r.direction == direction and not r.is_pattern)

    def to_json(self) -> str:
        """Return the plan as a single command-line argument."""
        return json.dumps(asdict(self))

    @classmethod
    def from_json(cls, text: str) -> Plan:
        """Parse the output of `to_json`."""
        data = json.loads(text)
        routes = tuple(Route(**route) for route in data.pop("routes"))
        outside = data.pop("outside")
        connect = tuple(outside.pop("connect"))
        return cls(routes=routes, outside=OutsideSettings(connect=connect, **outside), **data)
