# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""Clusters of the machine: CPUs that reach each other's data the fastest."""

from __future__ import annotations

from collections import defaultdict
from collections.abc import Collection, Iterable, Sequence
from dataclasses import dataclass

from rmw_manycore_py.platform.machine.sysfs import FULL_CAPACITY, Cache, Cpu

# A receive thread and three nodes. Fewer, such as the pairs of an Ampere Altra, are no cluster.
MIN_CPUS = 4
# A receive thread and a node: what a cluster must keep of its CPUs.
MIN_USABLE_CPUS = 2


@dataclass(frozen=True)
class HostCluster:
    """A cluster of the machine.

    :param cpus: host CPU of each core; first one hardware thread of each, then the others.
    :param node: NUMA node that its memory is in; None on kernels without NUMA.
    :param capacity: of each CPU; the fastest of the machine has 1024.
    :param cache: last-level cache that all CPUs share; None if there is none.
    """

    cpus: tuple[int, ...]
    node: int | None
    capacity: int
    cache: Cache | None

    @property
    def text(self) -> str:
        """What its CPUs have in common, for people."""
        words = []
        if self.cache is not None:
            words.append(f"L{self.cache.level} {self.cache.size_bytes / (1 << 20):g} MiB")
        if self.node is not None:
            words.append(f"NUMA node {self.node}")
        if self.capacity != FULL_CAPACITY:
            words.append(f"capacity {self.capacity} of {FULL_CAPACITY}")
        return ", ".join(words)


def clusters_of(
    cpus: Sequence[Cpu], usable: Collection[int] | None = None
) -> tuple[HostCluster, ...]:
    """Return the clusters of a machine, by their lowest CPU.

    CPUs are in one cluster if they share the last-level cache, else the kernel's cluster, else the
    NUMA node, and have the same capacity.

    :param usable: CPUs that clusters may have; a cluster with less than two of them is left out.
        Default: all.
    """
    groups: dict[tuple[frozenset[int], int | None], list[Cpu]] = defaultdict(list)
    for cpu in cpus:
        groups[_domain(cpu, cpus), cpu.node].append(cpu)
    clusters = [
        _cluster(kept)
        for group in groups.values()
        for equal in _by_capacity(group)
        if len(kept := _usable(equal, usable)) >= MIN_USABLE_CPUS
    ]
    return tuple(sorted(clusters, key=lambda cluster: min(cluster.cpus)))


def _domain(cpu: Cpu, cpus: Sequence[Cpu]) -> frozenset[int]:
    """Return the CPUs that this CPU is close to."""
    for near in (cpu.cache.cpus if cpu.cache else frozenset(), cpu.siblings):
        if len(near) >= MIN_CPUS:
            return near
    place = (cpu.package, cpu.node)
    return frozenset(one.number for one in cpus if (one.package, one.node) == place)


def _by_capacity(cpus: Iterable[Cpu]) -> list[list[Cpu]]:
    """Split CPUs by capacity; one alone, such as a prime core, joins the next slower ones."""
    groups: list[list[Cpu]] = []
    for cpu in sorted(cpus, key=lambda cpu: cpu.capacity):
        if groups and groups[-1][-1].capacity == cpu.capacity:
            groups[-1].append(cpu)
        else:
            groups.append([cpu])
    for index in range(len(groups) - 1, 0, -1):
        if len(groups[index]) < MIN_USABLE_CPUS:
            groups[index - 1] += groups.pop(index)
    return groups


def _usable(cpus: Iterable[Cpu], usable: Collection[int] | None) -> list[Cpu]:
    return [cpu for cpu in cpus if usable is None or cpu.number in usable]


def _cluster(cpus: Sequence[Cpu]) -> HostCluster:
    ordered = sorted(cpus, key=lambda cpu: (cpu.thread, cpu.number))
    first = ordered[0]
    shared = first.cache is not None and {cpu.number for cpu in cpus} <= first.cache.cpus
    return HostCluster(
        tuple(cpu.number for cpu in ordered),
        first.node,
        min(cpu.capacity for cpu in cpus),
        first.cache if shared else None,
    )
