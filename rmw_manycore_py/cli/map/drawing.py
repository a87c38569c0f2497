# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""Draws the clusters of a machine with their host CPUs."""

from __future__ import annotations

from collections.abc import Iterator

from rmw_manycore_py.mapfile import Placement
from rmw_manycore_py.platform.topology import RECEIVE_THREAD_CORE, Core

_CPUS_PER_LINE = 16


def drawing_of(placement: Placement) -> Iterator[str]:
    """Yield the lines of a drawing: each cluster with its CPUs, marked by what runs on them."""
    yield "this machine: R receive thread, * nodes or workers, . free"
    busy = {core.cluster for core in placement.host_cpus}
    used = {core for core in placement.host_cpus if core.core != RECEIVE_THREAD_CORE}
    used |= {node.place for node in placement.nodes}
    for cluster in placement.topology.clusters:
        host = cluster.host
        if host is None:
            continue
        yield f"cluster {cluster.id}: {host.text}"
        marks = ["*" if Core(cluster.id, core) in used else "." for core in range(cluster.cores)]
        if cluster.id in busy:
            marks[RECEIVE_THREAD_CORE] = "R"
        cpus = [f"{mark}{cpu:<3}" for mark, cpu in zip(marks, host.cpus, strict=True)]
        for first in range(0, len(cpus), _CPUS_PER_LINE):
            yield "  " + " ".join(cpus[first : first + _CPUS_PER_LINE]).rstrip()
