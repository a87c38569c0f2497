# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""Bridge process: both sides, and the routes between them."""

from __future__ import annotations

import faulthandler
import os
import re
import select
import sys
import zlib
from collections.abc import Callable, Iterable
from functools import partial
from importlib import import_module
from pathlib import Path

from rmw_manycore_bridge.counters import CounterFile, is_locked, status_path, take_pattern_files
from rmw_manycore_bridge.engines import load_engine
from rmw_manycore_bridge.inside import NODE_PREFIX, Inside
from rmw_manycore_bridge.lane import Lanes
from rmw_manycore_bridge.outside.interface import Joining, Outside, OutsideError
from rmw_manycore_bridge.outside.loop import Loop, Mover
from rmw_manycore_bridge.sides import OwnPublishers, Sides
from rmw_manycore_bridge.topic_role import TopicRole
from rmw_manycore_py.native import _transport
from rmw_manycore_py.process.readiness import report_ready
from rmw_manycore_py.process.signals import signal_inbox
from rmw_manycore_py.routes.plan import Plan
from rmw_manycore_py.routes.route import Direction, Route

_STOPPING_S = 4.5  # `manycore run` insists after 5 s
_LEAVING_S = 3.0


class BridgeProcess:
    """Runs until it is stopped or one of its threads fails."""

    def __init__(self, plan: Plan, direction: Direction, lane: int, core: tuple[int, int]) -> None:
        of_lane = plan.of(direction, lane)
        services = [route for route in plan.services(direction) if route in of_lane]
        patterns = [route for route in of_lane if route.is_pattern]
        routes = [*plan.topics(direction), *services, *patterns]
        stem = plan.outside.stem(direction)
        path = status_path(plan.platform, stem, lane)
        _require_alone(path)
        node_name = f"{node_stem(plan)}_{direction}{lane or ''}"
        self._plan = plan
        self._failed = os.eventfd(0)  # readable after a thread has failed
        self._inside = Inside(plan, core, f"{NODE_PREFIX}{stem}{lane or ''}", self._graphs_changed)
        self._before = take_pattern_files(plan.platform, stem, lane)
        engine = load_engine(plan.outside.engine)
        is_later = direction == "inward" and path.exists()
        engine.prepare(path.with_name(f"profile-{stem}-{lane}.xml"), is_later)
        counters = CounterFile.create(path, routes)
        own = OwnPublishers(plan)
        self._outsides = {
            domain: engine.open(
                Joining(plan, direction, domain, node_name, self._graphs_changed, own.is_noted)
            )
            for domain in sorted({route.domain for route in routes})
        }
        self._loops: list[Loop] = [self._inside, *self._outsides.values()]
        for outside in self._outsides.values():
            outside.show_nodes(self._inside)
        self._lanes = Lanes(plan, direction, lane)
        for index, (route, row) in enumerate(zip(routes, counters.rows, strict=True)):
            outside = self._outsides[route.domain]
            self._add(Sides(route, row, self._inside, outside, own), index)

    def _add(self, sides: Sides, index: int) -> None:
        try:
            mover, loop = self._mover(sides, index)
        except ImportError as error:
            sides.fail(str(error))
        except Exception as error:  # one failing route must not stop the others
            sides.fail(f"{type(error).__name__}: {error}")
        else:
            loop.movers.append(mover)

    def _mover(self, sides: Sides, index: int) -> tuple[Mover, Loop]:
        route = sides.route
        inward, is_service = route.direction == "inward", route.kind == "service"
        # Where publishers or servers are.
        source: Outside | Inside = sides.outside if inward != is_service else self._inside
        loop = sides.outside if is_service else source
        make = mover_class(route)
        if is_service:
            find, make_one = source.served, make
        else:
            find, make_one = source.published, lambda one: make(one, TopicRole(lane=one.route.lane))
        if route.is_pattern:
            from rmw_manycore_bridge.pattern import Pattern

            return Pattern(self._plan, sides, find, make_one, self._before), loop
        return (make(sides) if is_service else make(sides, self._lanes.topic_role(index))), loop

    def _graphs_changed(self) -> None:
        for loop in self._loops:
            loop.graphs_changed()

    def run(self) -> int:
        """Forward messages until a signal; return the exit status."""
        with signal_inbox() as inbox:
            for loop in self._loops:
                loop.on_failure(partial(os.eventfd_write, self._failed, 1))
                loop.start()
            report_ready()
            endings = [inbox.fileno(), self._failed]
            try:
                while not select.select(endings, [], [], self._lanes.period_s)[0]:
                    if self._lanes.poll():
                        self._graphs_changed()
            finally:  # an I/O error of the table ends the process; the runner restarts it
                # An engine that never returns is shown with the call that waits for it.
                faulthandler.dump_traceback_later(_STOPPING_S)
                for loop in self._loops:
                    loop.stop()
            try:
                for loop in self._loops:
                    loop.close_movers()
                exit_status = _report(self._loops)
                # Nothing is left to forward; Fast DDS at times never returns from leaving a domain.
                _transport.exit_after(_LEAVING_S, exit_status)
                for loop in reversed(self._loops):
                    loop.close()
            finally:
                faulthandler.cancel_dump_traceback_later()
            os.close(self._failed)
            return exit_status


def mover_class(route: Route) -> Callable[..., Mover]:
    """Return the class that forwards a route; processes load what they use, to be up soon."""
    way, kind = route.direction, route.kind
    module = import_module(f"rmw_manycore_bridge.{kind}_{way}")
    found: Callable[..., Mover] = getattr(module, f"{way.title()}{kind.title()}")
    return found


def _require_alone(path: Path) -> None:
    """Refuse a second process with the counter file: what crosses would cross twice, and echo."""
    if is_locked(path) and (counters := CounterFile.open(path)) is not None:
        raise OutsideError(
            f"process {counters.pid} bridges this platform already: stop it, or name all that "
            "crosses in one file"
        )


def _report(loops: Iterable[Loop]) -> int:
    failures = [(loop.name, loop.failure) for loop in loops if loop.failure is not None]
    for name, failure in failures:
        print(f"{name}: {type(failure).__name__}: {failure}", file=sys.stderr)
    return 1 if failures else 0


def node_stem(plan: Plan) -> str:
    """Return the node name prefix of a platform's bridge, the same at each start.

    It differs between two platforms of one name on different hosts, and between hosts of one.
    """
    if plan.outside.host:
        return f"manycore_host_{plan.outside.host}"
    text = f"{os.uname().nodename}/{os.getuid()}/{plan.platform}"
    readable = re.sub(r"\W", "_", plan.platform, flags=re.ASCII).strip("_")
    return f"manycore_bridge_{readable}_{zlib.crc32(text.encode()):08x}"
