# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""Assigns cores to nodes and their workers, and host CPUs to cores."""

from __future__ import annotations

from collections.abc import Collection, Mapping, Sequence
from dataclasses import dataclass, field
from itertools import chain, count

from rmw_manycore_py.errors import MapfileError, Problem
from rmw_manycore_py.mapfile.format.mapfile import Mapfile
from rmw_manycore_py.mapfile.placing.placement import Placement
from rmw_manycore_py.platform.topology import (
    RECEIVE_THREAD_CORE,
    Core,
    assign_host_cpus,
    isolated_cpus,
)


@dataclass(frozen=True)
class Kept:
    """Places of nodes that run: what a mapfile leaves open stays as it is.

    :param cores: by node.
    :param host_cpus: of cores for which no mapfile named one.
    """

    cores: Mapping[str, Core] = field(default_factory=dict)
    host_cpus: Mapping[Core, int] = field(default_factory=dict)

    @classmethod
    def of(cls, mapfile: Mapfile, placement: Placement) -> Kept:
        """Return the places in a placement of a mapfile."""
        sections = mapfile.sections.nodes
        nodes = placement.nodes
        named = {node.place for node in nodes if sections[node.name].host_cpu is not None}
        cpus = {core: cpu for core, cpu in placement.host_cpus.items() if core not in named}
        return cls({node.name: node.place for node in nodes}, cpus)

    def cores_in(self, mapfile: Mapfile, taken: Collection[Core]) -> dict[str, Core]:
        """Return the cores that a mapfile leaves to nodes that have them."""
        return {
            name: core
            for name, core in self.cores.items()
            if (node := mapfile.sections.nodes.get(name)) is not None
            and (node.cluster, node.core) == (core.cluster, None)
            and core not in taken
        }


FRESH = Kept()


def assign_cores(
    mapfile: Mapfile, occupied: Collection[Core] = (), kept: Kept = FRESH
) -> dict[str, Core]:
    """Return each node's core; nodes without one get the first free core of their cluster.

    Where the cores do not suffice, numbers beyond them follow, which `check_room` refuses.

    :param occupied: cores used by nodes of other runs on the platform.
    """
    nodes = mapfile.sections.nodes
    taken = {Core(node.cluster, node.core) for node in nodes.values() if node.core is not None}
    _check_occupied(mapfile, taken & set(occupied))
    taken |= set(occupied)
    stays = kept.cores_in(mapfile, taken)
    taken |= set(stays.values())
    cores: dict[str, Core] = {}
    for name, node in nodes.items():
        if node.core is not None:
            cores[name] = Core(node.cluster, node.core)
            continue
        if name in stays:
            cores[name] = stays[name]
            continue
        cluster = mapfile.topology.clusters[node.cluster - 1]
        numbers = chain(cluster.free, count(cluster.cores))
        cores[name] = next(
            core for core in (Core(cluster.id, number) for number in numbers) if core not in taken
        )
        taken.add(cores[name])
    return cores


def worker_cores(
    mapfile: Mapfile, used: Collection[Core]
) -> tuple[dict[str, tuple[Core, ...]], list[Problem]]:
    """Return the cores of each node's workers, and the nodes for whose workers none are left.

    They are the first free ones of the node's cluster.
    """
    taken = set(used)
    cores: dict[str, tuple[Core, ...]] = {}
    problems = []
    for name, node in mapfile.sections.nodes.items():
        cluster = mapfile.topology.clusters[node.cluster - 1]
        free = [core for core in cluster.free if Core(cluster.id, core) not in taken]
        if node.workers > len(free):
            expected = f"at most {len(free)}, the cores that are left in cluster {cluster.id}"
            path = ("nodes", name, "workers")
            problems.append(mapfile.document.problem(path, expected, str(node.workers)))
        cores[name] = tuple(Core(cluster.id, core) for core in free[: node.workers])
        taken.update(cores[name])
    return cores, problems


def _check_occupied(mapfile: Mapfile, both: Collection[Core]) -> None:
    if mapfile.sections.allow_shared_cores:
        return
    problems = []
    for name, node in mapfile.sections.nodes.items():
        if node.core is not None and (core := Core(node.cluster, node.core)) in both:
            expected = "a core that no node on the platform has (allow_shared_cores: true lifts it)"
            problems.append(mapfile.document.problem(("nodes", name, "core"), expected, str(core)))
    if problems:
        raise MapfileError(*problems)


def assign_cpus(
    mapfile: Mapfile,
    used: Sequence[Core],
    beside: Collection[int],
    cpus: Sequence[int],
    kept: Kept = FRESH,
) -> dict[Core, int]:
    """Return the host CPU of every used core: nodes, workers, then receive threads.

    :param beside: clusters of the bridge.

    The bridge may run on any CPU or on those named in the mapfile: its cores get none. Isolated
    CPUs are only assigned to nodes that name them. Cores of a machine have their CPUs.
    """
    clusters = {core.cluster for core in used} | {*beside}
    receivers = [Core(cluster, RECEIVE_THREAD_CORE) for cluster in sorted(clusters)]
    cores = [*used, *receivers]
    fixed = _chosen_cpus(mapfile, used, cpus)
    own = {core: mapfile.topology.host_cpu(core) for core in cores}
    of_machine = {core: cpu for core, cpu in own.items() if cpu is not None}
    stay = {core: cpu for core, cpu in kept.host_cpus.items() if core in cores and cpu in cpus}
    return assign_host_cpus(cores, {**stay, **fixed, **of_machine}, cpus)


def _chosen_cpus(mapfile: Mapfile, used: Sequence[Core], cpus: Sequence[int]) -> dict[Core, int]:
    """Return the host CPUs that the mapfile names."""
    fixed: dict[Core, int] = {}
    problems: list[Problem] = []
    nameable = sorted({*cpus, *isolated_cpus()})
    usable = f"a CPU this process may use ({', '.join(map(str, nameable))})"
    for cpu in mapfile.sections.bridge.host_cpu or ():
        if cpu not in nameable:
            problems.append(mapfile.document.problem(("bridge", "host_cpu"), usable, str(cpu)))
    for (name, node), core in zip(mapfile.sections.nodes.items(), used, strict=False):
        if node.host_cpu is None:
            continue
        path = ("nodes", name, "host_cpu")
        own = mapfile.topology.host_cpu(core)
        if own not in (None, node.host_cpu):
            expected = f"{own}, which {core} of this machine is"
            problems.append(mapfile.document.problem(path, expected, str(node.host_cpu)))
        if own is None and node.host_cpu not in nameable:
            problems.append(mapfile.document.problem(path, usable, str(node.host_cpu)))
        if node.host_cpu != fixed.setdefault(core, node.host_cpu):
            expected = f"{fixed[core]}, as another node on core {core.core} has it"
            problems.append(mapfile.document.problem(path, expected, str(node.host_cpu)))
    if problems:
        raise MapfileError(*problems)
    return fixed
