# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""A bridge without a run, and nodes on both of its sides."""

from __future__ import annotations

import copy
import sys
from collections.abc import Callable
from functools import partial
from typing import Any

from rmw_manycore_bridge.status import status
from rmw_manycore_py.routes.outside import OutsideSettings
from rmw_manycore_py.routes.plan import Plan
from rmw_manycore_py.routes.route import DIRECTIONS, Direction, Route, arranged
from support.nodes.zenoh_peers import free_port, locator, route
from support.peers.programs import forked_node
from support.processes.commands import peer_command
from support.processes.domains import domain_of
from support.processes.program import Program

OUTSIDE = {"RMW_IMPLEMENTATION": "rmw_fastrtps_cpp"}
STRING = "std_msgs/msg/String"


class Bridge:
    """Start bridge processes and nodes; they all end with the test."""

    settings = OutsideSettings()

    def __init__(self, start: Callable[..., Program], platform: str) -> None:
        self._start = start
        self.platform = platform
        self.domain = domain_of(platform)

    def route(self, direction: Direction, name: str, type_name: str = STRING, **more: Any) -> Route:
        """Return a route that has one name on both sides."""
        kind: Any = "topic" if not type_name or "/msg/" in type_name else "service"
        settings = {"inside": name, "outside": name, "domain": self.domain, **more}
        return Route(kind=kind, direction=direction, type=type_name, **settings)

    def pattern(self, direction: Direction, name: str, **more: Any) -> Route:
        """Return a route for all topics that fit a pattern."""
        return self.route(direction, name, "", **more)

    def run(self, *routes: Route) -> dict[str, Program]:
        """Start the processes that the routes need; return them by direction."""
        plan = Plan(self.platform, arranged(routes, 1), self.settings)
        return {way: self.run_one(plan, way) for way in DIRECTIONS if plan.of(way, 0)}

    def run_lanes(self, lanes: int, way: Direction, *routes: Route) -> list[Program]:
        """Start all lanes of one direction."""
        plan = Plan(self.platform, arranged(routes, lanes))
        return [self.run_one(plan, way, lane) for lane in range(lanes)]

    def run_one(self, plan: Plan, way: Direction, lane: int = 0, **env: str) -> Program:
        """Start one process."""
        command = forked_node("rmw_manycore_bridge", *_words(plan, way, lane))
        return self._start(command, **OUTSIDE, **env)

    def run_unforked(self, plan: Plan, way: Direction, **env: str) -> Program:
        """Start one process in its own interpreter: all of its threads are the bridge's."""
        command = [sys.executable, "-m", "rmw_manycore_bridge", *_words(plan, way, 0)]
        return self._start(command, **OUTSIDE, **env)

    def inside(self, function: Callable[..., None], *arguments: Any, **env: str) -> Program:
        """Start a node on the platform."""
        return self._start(peer_command(function, *arguments), **env)

    def outside(self, function: Callable[..., None], *arguments: Any, **env: str) -> Program:
        """Start a node in the DDS domain."""
        return self._start(peer_command(function, *arguments), **{**OUTSIDE, **env})

    def row(self, direction: Direction, name: str) -> dict[str, Any]:
        """Return the counters of a route; None before its process has counted."""
        found = [r for r in self.rows() if (r["direction"], r["inside"]) == (direction, name)]
        return found[0] if found else {}

    def rows(self) -> list[dict[str, Any]]:
        """Return the counters of all routes."""
        return status(self.platform)


class ZenohBridge(Bridge):
    """Bridge to rmw_zenoh, with a router."""

    def __init__(self, start: Callable[..., Program], platform: str) -> None:
        super().__init__(start, platform)
        self.port = free_port()
        self.settings = OutsideSettings("zenoh", (locator(self.port),))
        self.start_router()

    def beside(self, platform: str) -> ZenohBridge:
        """Return the bridge of another platform in the same domain."""
        made = copy.copy(self)
        made.platform = platform
        made._start = partial(self._start, MANYCORE_PLATFORM=platform)
        return made

    def start_router(self) -> None:
        """Start the router, or another one in its place."""
        self.router = self._start(peer_command(route, self.port), **OUTSIDE)
        self.router.wait_for("^routing$")

    def outside(self, function: Callable[..., None], *arguments: Any, **env: str) -> Program:
        """Start a peer in the domain."""
        return self.outside_of_domain(function, self.domain, *arguments, **env)

    def outside_of_domain(
        self, function: Callable[..., None], *arguments: Any, **env: str
    ) -> Program:
        """Start a peer that has no domain."""
        return self._start(peer_command(function, self.port, *arguments), **{**OUTSIDE, **env})


def _words(plan: Plan, way: Direction, lane: int) -> list[str]:
    return [plan.to_json(), way, str(lane), "1", str(2 + DIRECTIONS.index(way))]
