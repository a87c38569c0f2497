# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""Nodes of the reference system, from its mapfile."""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import Any

from rmw_manycore_py.errors import ManycoreError
from rmw_manycore_py.mapfile import PlacedNode, check
from rmw_manycore_py.mapfile.installed import find_mapfile
from rmw_manycore_py.papers.reference_system.sample_path import HOT_PATH, PLANNER
from rmw_manycore_py.process.scheduling import Scheduling

MAPFILE = "autoware_reference"
# Priorities used by upstream's benchmarks.
REAL_TIME = {**dict.fromkeys(HOT_PATH, Scheduling("fifo", 1)), PLANNER: Scheduling("fifo", 30)}


@dataclass(frozen=True)
class Member:
    """A node of the system, and its placement."""

    name: str
    kind: str
    inputs: tuple[str, ...]
    outputs: tuple[str, ...]
    period_ms: int
    cluster: int
    host_cpu: int
    scheduling: Scheduling | None = None


def members() -> tuple[Member, ...]:
    """Return all nodes, placed as by `manycore run autoware_reference`."""
    path = find_mapfile(MAPFILE)
    if path is None:
        raise ManycoreError(f"the mapfile {MAPFILE} is not installed")
    return tuple(_member(node) for node in check(path).nodes)


def _member(node: PlacedNode) -> Member:
    parameters: dict[str, Any] = dict(node.parameters)
    return Member(
        name=node.name,
        kind=parameters["kind"],
        inputs=tuple(parameters.get("inputs", ())),
        outputs=tuple(parameters.get("outputs", (node.name,))),
        period_ms=parameters.get("period_ms", 0),
        cluster=node.cluster,
        host_cpu=node.host_cpu,
    )


def in_real_time(system: tuple[Member, ...]) -> tuple[Member, ...]:
    """Return the system with upstream's priorities for hot path and planner."""
    return tuple(replace(member, scheduling=REAL_TIME.get(member.name)) for member in system)


def in_one_cluster(system: tuple[Member, ...]) -> tuple[Member, ...]:
    """Return the system with all nodes in cluster 1, enlarged beyond Coolidge's 16 cores."""
    return tuple(replace(member, cluster=1) for member in system)


def with_hot_path_split(system: tuple[Member, ...]) -> tuple[Member, ...]:
    """Return the system with each node of the hot path in another cluster than the previous."""
    clusters = sorted({member.cluster for member in system})
    split = {name: clusters[i % len(clusters)] for i, name in enumerate(HOT_PATH)}
    return tuple(replace(m, cluster=split.get(m.name, m.cluster)) for m in system)
