# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""Pairs of CPUs, by what they have in common."""

from __future__ import annotations

from collections.abc import Sequence

from rmw_manycore_py.platform.machine.clusters import HostCluster
from rmw_manycore_py.platform.machine.sysfs import Cpu

SAME_CPU, SAME_CORE, SAME_CLUSTER = "same CPU", "same core", "same cluster"
SAME_NODE, OTHER_NODE = "same NUMA node", "other NUMA node"
KINDS = (SAME_CPU, SAME_CORE, SAME_CLUSTER, SAME_NODE, OTHER_NODE)


def kind_of(one: Cpu, other: Cpu, clusters: Sequence[HostCluster]) -> str:
    """Return the nearest of KINDS that holds for two CPUs."""
    if one.number == other.number:
        return SAME_CPU
    if other.number in one.threads:
        return SAME_CORE
    if any({one.number, other.number} <= set(cluster.cpus) for cluster in clusters):
        return SAME_CLUSTER
    return SAME_NODE if one.node == other.node else OTHER_NODE


def nearest_pairs(
    cpus: Sequence[Cpu], clusters: Sequence[HostCluster]
) -> dict[str, tuple[int, int]]:
    """Return the first CPU with the first other one of each kind that there is, nearest first."""
    first = cpus[0]
    found: dict[str, tuple[int, int]] = {}
    for other in cpus:
        found.setdefault(kind_of(first, other, clusters), (first.number, other.number))
    return {kind: found[kind] for kind in KINDS if kind in found}
