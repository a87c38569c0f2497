# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""Cores for the workers of a node: pinned processes that share its computation."""

from __future__ import annotations

from collections.abc import Collection

from rmw_manycore_py.errors import MapfileError
from rmw_manycore_py.mapfile.format.mapfile import Mapfile
from rmw_manycore_py.platform.topology import Core


def worker_cores(mapfile: Mapfile, used: Collection[Core]) -> dict[str, tuple[Core, ...]]:
    """Return the cores of each node's workers: the first free ones of its cluster."""
    taken = set(used)
    cores: dict[str, tuple[Core, ...]] = {}
    for name, node in mapfile.sections.nodes.items():
        cluster = mapfile.topology.clusters[node.cluster - 1]
        free = [core for core in cluster.free if Core(cluster.id, core) not in taken]
        if node.workers > len(free):
            expected = f"at most {len(free)}, the cores that are left in cluster {cluster.id}"
            path = ("nodes", name, "workers")
            raise MapfileError(mapfile.document.problem(path, expected, str(node.workers)))
        cores[name] = tuple(Core(cluster.id, core) for core in free[: node.workers])
        taken.update(cores[name])
    return cores
