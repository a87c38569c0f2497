# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""Context of an active route: both sides, its counters, and this bridge's publishers."""

from __future__ import annotations

import sys
from dataclasses import dataclass
from pathlib import Path

from rmw_manycore_bridge.counters import CounterFile, Row
from rmw_manycore_bridge.inside import Inside
from rmw_manycore_bridge.outside.interface import Outside
from rmw_manycore_py.native import _transport
from rmw_manycore_py.routes.plan import Plan
from rmw_manycore_py.routes.route import Route


class OwnPublishers:
    """Looks up publishers of all processes of this bridge by gid, in their counter files."""

    def __init__(self, plan: Plan) -> None:
        self._directory = Path(_transport.platform_directory(plan.platform))
        self._stems = plan.outside.stems()
        self._known: dict[bytes, bool] = {}

    def has(self, gid: bytes) -> bool:
        """Return whether a message with that gid was published by this bridge."""
        known = self._known.get(gid)
        if known is None:
            known = self._known[gid] = self.is_noted(gid)
        return known

    def is_noted(self, gid: bytes) -> bool:
        """Return whether a process has registered a publisher yet."""
        paths = (path for s in self._stems for path in self._directory.glob(f"bridge-{s}[-_]*"))
        files = (CounterFile.open(path) for path in paths)
        return any(row.has_gid(gid) for file in files if file for row in file.rows)


@dataclass(frozen=True)
class Sides:
    """Context of one route."""

    route: Route
    row: Row
    inside: Inside
    outside: Outside
    own: OwnPublishers
    file: CounterFile | None = None  # counter file of the row, if it has its own

    def fail(self, reason: str) -> None:
        """Mark the route as failed, and print the reason once."""
        line = " ".join(reason.split())  # some errors span several lines
        before = self._standing()
        self.row.set_state("failed", line)
        if self._standing() != before:  # compare stored text: a row truncates it
            self.report(line)

    def _standing(self) -> tuple[str, str]:
        values = self.row.as_dict()
        return values["state"], values["reason"]

    def report(self, text: str) -> None:
        """Print a line about the route."""
        print(f"{self.route.inside}: {text}", file=sys.stderr, flush=True)
