# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""Generates a plan from a profile: an application of which there is nothing else."""

from __future__ import annotations

import json
import re
from collections.abc import Iterator

from rmw_manycore_py.errors import EXIT_BAD_INPUT, ManycoreError
from rmw_manycore_py.platform.topology import Core, Topology
from rmw_manycore_py.profile.model import Profile
from rmw_manycore_py.ros.names import MAX_NODE_NAME, NAME_PART

_NAME = re.compile(f"/{NAME_PART}(/{NAME_PART})*")


def plan_of(profile: Profile, topology: Topology) -> str:
    """Return a mapfile with a profile's nodes, one core after the other.

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
    cores = [Core(one.id, core) for one in topology.clusters for core in one.free]
    is_shared = len(processes) > len(cores)
    return "\n".join(
        [*_head(topology.profile, is_shared), *_lines(processes, cores, is_shared), ""]
    )


def _head(platform: str, is_shared: bool) -> Iterator[str]:
    yield "# Choose the clusters, or let `manycore advise` choose them."
    yield f"platform: {platform}"
    yield "plan: true  # from a profile: each command is the process that was recorded"
    if is_shared:
        yield "allow_shared_cores: true"
    yield "nodes:"


def _lines(processes: dict[str, str | None], cores: list[Core], is_shared: bool) -> Iterator[str]:
    for number, (name, process) in enumerate(processes.items()):
        place = cores[number % len(cores)]
        core = f", core: {place.core}" if is_shared else ""
        command = json.dumps([process or "unknown"])
        yield f"  {name}: {{cluster: {place.cluster}{core}, command: {command}}}"
