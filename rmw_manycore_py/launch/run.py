# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""A whole run: platform up, nodes up, nodes down, platform down."""

from __future__ import annotations

from collections.abc import Iterable

from rmw_manycore_py.launch.bridge import bridge_programs
from rmw_manycore_py.launch.events import Finished, Notice, PlacedCore, Platform
from rmw_manycore_py.launch.helpers import helper_programs
from rmw_manycore_py.launch.platform import configured_platform, remaining_users
from rmw_manycore_py.launch.processes.program import NodeProgram
from rmw_manycore_py.launch.runner import Report, Runner
from rmw_manycore_py.mapfile.placing.placement import Placement
from rmw_manycore_py.signals import SignalInbox, signal_inbox
from rmw_manycore_py.topology import RECEIVE_THREAD_CORE

RECEIVE_THREAD = "(receive thread)"  # no node can have a name with blanks


class Run:
    """The nodes of a placement and its bridge, on a platform of their own."""

    def __init__(self, placement: Placement) -> None:
        self._placement = placement
        self._bridge = bridge_programs(placement)
        self._helpers = helper_programs(placement)

    @property
    def program_names(self) -> list[str]:
        """The names under which the processes of the run print."""
        nodes = [node.name for node in self._placement.nodes]
        return [p.name for p in self._bridge] + nodes + [p.name for p in self._helpers]

    def run(self, report: Report, duration_s: float | None = None) -> int:
        """Start all processes, wait until they have ended, and return the exit status."""
        with signal_inbox() as inbox:
            return self._run(inbox, report, duration_s)

    def _run(self, inbox: SignalInbox, report: Report, duration_s: float | None) -> int:
        placement = self._placement
        for text in placement.notices:
            report(Notice(text))
        with configured_platform(placement):
            report(_describe(placement, self._bridge))
            nodes = [NodeProgram.of(node) for node in placement.nodes]
            runner = Runner([*self._bridge, *nodes, *self._helpers], report)
            exit_status = runner.run(inbox, duration_s)
        if users := remaining_users(placement.name):
            report(Notice(f"platform {placement.name} stays, for {', '.join(users)}"))
        report(Finished(runner.failed, exit_status))
        return exit_status


def _describe(placement: Placement, bridge: Iterable[NodeProgram]) -> Platform:
    topology = placement.topology
    nodes = [PlacedCore(node.name, *node.place, node.host_cpu) for node in placement.nodes]
    workers = [
        PlacedCore(f"(worker of {node.name})", *core, cpu)
        for node in placement.nodes
        for core, cpu in node.workers
    ]
    crossing = [PlacedCore(one.name, *one.core, one.host_cpu) for one in bridge]
    receive_threads = [
        PlacedCore(RECEIVE_THREAD, *core, cpu)
        for core, cpu in placement.host_cpus.items()
        if core.core == RECEIVE_THREAD_CORE
    ]
    return Platform(
        name=placement.name,
        profile=topology.profile,
        clusters=len(topology.clusters),
        cores_per_cluster=topology.cores_per_cluster,
        smem_size=topology.smem_size,
        cores=(*nodes, *workers, *crossing, *receive_threads),
    )
