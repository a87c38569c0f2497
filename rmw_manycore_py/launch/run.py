# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""A whole run: platform up, nodes up, nodes down, platform down."""

from __future__ import annotations

from rmw_manycore_py.launch.events import Finished, Notice, PlacedCore, Platform
from rmw_manycore_py.launch.platform import configured_platform, remaining_users
from rmw_manycore_py.launch.program import NodeProgram
from rmw_manycore_py.launch.runner import Report, Runner
from rmw_manycore_py.mapfile.placement import Placement
from rmw_manycore_py.topology import RECEIVE_THREAD_CORE

RECEIVE_THREAD = "(receive thread)"  # no node can have a name with blanks


def run_placement(placement: Placement, report: Report, duration_s: float | None = None) -> int:
    """Run the nodes of a placement on a platform of their own; return the exit status."""
    for text in (*placement.notices, *_bridge_notices(placement)):
        report(Notice(text))
    with configured_platform(placement):
        report(_describe(placement))
        runner = Runner([NodeProgram.of(node) for node in placement.nodes], report)
        exit_status = runner.run(duration_s)
    if users := remaining_users(placement.name):
        report(Notice(f"platform {placement.name} stays, for {', '.join(users)}"))
    report(Finished(runner.failed, exit_status))
    return exit_status


def _bridge_notices(placement: Placement) -> list[str]:
    if placement.bridge is None:
        return []
    return ["topic_in and topic_to join nothing yet: no bridge to the outside is started"]


def _describe(placement: Placement) -> Platform:
    topology = placement.topology
    nodes = [PlacedCore(node.name, *node.place, node.host_cpu) for node in placement.nodes]
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
        cores=(*nodes, *receive_threads),
    )
