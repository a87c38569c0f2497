# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""Generates a plan from a profile: an application of which there is nothing else."""

from __future__ import annotations

import json
import re
from collections.abc import Iterator
from itertools import cycle

from rmw_manycore_py.errors import EXIT_BAD_INPUT, ManycoreError
from rmw_manycore_py.mapfile.communication import Talk, by_communication, talk_of
from rmw_manycore_py.platform.topology import Topology
from rmw_manycore_py.profile.model import Profile
from rmw_manycore_py.ros.names import MAX_NODE_NAME, NAME_PART

_NAME = re.compile(f"/{NAME_PART}(/{NAME_PART})*")


def plan_of(profile: Profile, topology: Topology) -> str:
    """Return a mapfile with a profile's nodes; those that exchange most messages share a cluster.

    They share cores where the platform has too few.

    :raises ManycoreError: if the profile has no node.
    """
    processes = {
        one.name: None if one.process is None else profile.processes[one.process].name
        for one in profile.nodes
        if _NAME.fullmatch(one.name) and len(one.name) <= MAX_NODE_NAME
    }
    if not processes:
        raise ManycoreError("the profile has no node to place", EXIT_BAD_INPUT)
    cores = sum(len(cluster.free) for cluster in topology.clusters)
    per_core = -(-len(processes) // cores)
    room = {cluster.id: len(cluster.free) * per_core for cluster in topology.clusters}
    clusters = by_communication([*processes], _talk(profile), room)
    lines = _lines(processes, clusters, topology if per_core > 1 else None)
    return "\n".join([*_head(topology.profile, per_core > 1), *lines, ""])


def _talk(profile: Profile) -> Talk[str]:
    names = [node.name for node in profile.nodes]
    return talk_of(
        (
            (names[one.node], one.topic, 1.0 if one.publications is None else one.publications)
            for one in profile.publishers
            if one.node is not None and one.publications != 0
        ),
        ((names[one.node], one.topic) for one in profile.subscriptions if one.node is not None),
    )


def _head(platform: str, is_shared: bool) -> Iterator[str]:
    yield "# Nodes that exchange messages share a cluster. `manycore advise` weighs loads, too."
    yield f"platform: {platform}"
    yield "plan: true  # from a profile: each command is the process that was recorded"
    if is_shared:
        yield "allow_shared_cores: true"
    yield "nodes:"


def _lines(
    processes: dict[str, str | None], clusters: dict[str, int], shared: Topology | None
) -> Iterator[str]:
    cores = {one.id: cycle(one.free) for one in shared.clusters} if shared else {}
    for name, process in processes.items():
        cluster = clusters[name]
        core = f", core: {next(cores[cluster])}" if cores else ""
        command = json.dumps([process or "unknown"])
        yield f"  {name}: {{cluster: {cluster}{core}, command: {command}}}"
