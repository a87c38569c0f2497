# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""Bridge processes as programs of the runner."""

from __future__ import annotations

from contextlib import closing

from rmw_manycore_program import own_program
from rmw_manycore_py.errors.missing_library import ZENOH, require_installed
from rmw_manycore_py.launch.events import Finished
from rmw_manycore_py.launch.processes.environment import outside_environment
from rmw_manycore_py.launch.processes.program import NodeProgram
from rmw_manycore_py.launch.runner import Report, Runner
from rmw_manycore_py.mapfile.placing.placement import BridgePlacement, Placement
from rmw_manycore_py.platform.topology import Core
from rmw_manycore_py.process.signals import signal_inbox
from rmw_manycore_py.routes.plan import Plan
from rmw_manycore_py.routes.route import DIRECTIONS, Direction

# Cores of a bridge without a mapfile: the first that are not reserved.
_STANDALONE_CORES = (Core(1, 1), Core(1, 2))


def bridge_programs(placement: Placement) -> list[NodeProgram]:
    """Return a program for each process of the bridge, and of the links to other hosts."""
    return [one for bridge in placement.crossings for one in _programs(placement.name, bridge)]


def _programs(platform: str, bridge: BridgePlacement) -> list[NodeProgram]:
    plan = Plan(platform, bridge.routes, bridge.outside)
    _require_engine(plan)
    return [
        bridge_program(plan, direction, lane, core, bridge.host_cpus)
        for lane in range(len(bridge.cores))
        for direction in DIRECTIONS
        if lane < plan.lanes(direction)
        for core in [bridge.core(direction, lane)]
    ]


def run_bridge(plan: Plan, report: Report) -> int:
    """Run the bridge of a running platform until a signal."""
    _require_engine(plan)
    programs = [
        bridge_program(plan, direction, 0, core, host_cpus=())
        for direction, core in zip(DIRECTIONS, _STANDALONE_CORES, strict=True)
        if plan.of(direction, 0)
    ]
    with closing(Runner(programs, report)) as runner, signal_inbox() as inbox:
        exit_status = runner.run(inbox)
        report(Finished(runner.failed, exit_status))
    return exit_status


def _require_engine(plan: Plan) -> None:
    if plan.outside.engine in ("zenoh", "hosts"):
        require_installed(ZENOH)


def bridge_program(
    plan: Plan, direction: Direction, lane: int, core: Core, host_cpus: tuple[int, ...]
) -> NodeProgram:
    """Return the program of one bridge process."""
    words = (plan.to_json(), direction, *map(str, (lane, *core)))
    return NodeProgram(
        name=f"({plan.outside.title(direction)}{f' {lane}' if lane else ''})",
        command=own_program("rmw_manycore_bridge", *words),
        environment=outside_environment(),
        core=core,
        host_cpus=host_cpus,
        supervised=True,
    )
