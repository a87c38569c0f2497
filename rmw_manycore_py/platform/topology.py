# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""Shapes of platforms: clusters, cores, reserved cores, and host CPUs of cores."""

from __future__ import annotations

import os
import shlex
from collections import Counter
from collections.abc import Collection, Iterable, Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import NamedTuple

from rmw_manycore_py.errors import EXIT_BAD_INPUT, ManycoreError
from rmw_manycore_py.platform.machine.clusters import HostCluster, clusters_of
from rmw_manycore_py.platform.machine.sysfs import cpus_of_list, read_cpus

MIB = 1024 * 1024
RECEIVE_THREAD_CORE = 0
# Affinity of a process: one CPU, several, or None for all.
HostCpu = int | tuple[int, ...] | None
# An I/O cluster has no reserved core for OS tasks: Linux runs on it anyway.
IO_CLUSTER_CORES = 4
# Environment variable of a node with workers: their host CPUs, comma-separated. Defined here, since
# a node restarted after a kill should not spend time on importing `mapfile`.
WORKER_CPUS = "MANYCORE_WORKER_CPUS"


class Core(NamedTuple):
    """A core; clusters are numbered from 1, cores from 0."""

    cluster: int
    core: int

    def __str__(self) -> str:
        return f"cluster {self.cluster} core {self.core}"


@dataclass(frozen=True)
class Cluster:
    """One cluster with its local memory (SMEM); of a machine, with its place there."""

    id: int
    cores: int
    smem_size: int
    host: HostCluster | None = None

    @property
    def reserved(self) -> frozenset[int]:
        """Cores of the receive thread and of OS tasks, without nodes."""
        if self.cores <= IO_CLUSTER_CORES:
            return frozenset({RECEIVE_THREAD_CORE})
        return frozenset({RECEIVE_THREAD_CORE, self.cores - 1})

    @property
    def free(self) -> tuple[int, ...]:
        """Cores available to nodes."""
        return tuple(core for core in range(self.cores) if core not in self.reserved)


@dataclass(frozen=True)
class Topology:
    """The clusters of a platform."""

    profile: str
    clusters: tuple[Cluster, ...]

    @property
    def cores_per_cluster(self) -> int:
        """Number of cores of the largest cluster."""
        return max(cluster.cores for cluster in self.clusters)

    @property
    def smem_size(self) -> int:
        """Local memory per cluster, in bytes."""
        return self.clusters[0].smem_size

    def cluster(self, number: int) -> Cluster | None:
        """Return the cluster of that number; None if there is none."""
        return self.clusters[number - 1] if 1 <= number <= len(self.clusters) else None

    @property
    def is_machine(self) -> bool:
        """Whether clusters are those of this machine, and each core is a host CPU."""
        return self.profile == MACHINE

    def host_cpu(self, core: Core) -> int | None:
        """Return the host CPU that a core is; None if any CPU may stand for it."""
        cluster = self.cluster(core.cluster)
        if cluster is None or cluster.host is None or core.core >= cluster.cores:
            return None
        return cluster.host.cpus[core.core]


MACHINE = "machine"
PROFILES = ("host", MACHINE, "coolidge", "bostan")


def profile(
    name: str,
    *,
    clusters: int | None = None,
    cores_per_cluster: int | None = None,
    smem_size: int | None = None,
) -> Topology:
    """Return a profile's shape, with the given parts replaced; a machine keeps its clusters.

    :raises ManycoreError: if this process may use no cluster of the machine.
    """
    if name == MACHINE:
        return of_machine(machine_clusters(), smem_size)
    shapes = {
        "host": (5, 16, 0, None),
        "coolidge": (5, 16, 0, 4 * MIB),
        "bostan": (16, 16, 4, 2 * MIB),
    }
    own_clusters, own_cores, io_clusters, own_smem = shapes[name]
    count = clusters or own_clusters
    if clusters is not None:
        io_clusters = 0
    cores = [cores_per_cluster or own_cores] * count + [IO_CLUSTER_CORES] * io_clusters
    smem = smem_size or own_smem or host_smem_size(len(cores))
    return Topology(name, tuple(Cluster(i, n, smem) for i, n in enumerate(cores, start=1)))


def of_machine(clusters: Sequence[HostCluster], smem_size: int | None = None) -> Topology:
    """Return the platform whose cores are the CPUs of these clusters.

    :raises ManycoreError: if there are none.
    """
    if not clusters:
        text = "no cluster has two CPUs that this process may use: choose the platform 'host'"
        raise ManycoreError(text, EXIT_BAD_INPUT)
    smem = smem_size or host_smem_size(len(clusters))
    numbered = enumerate(clusters, start=1)
    return Topology(MACHINE, tuple(Cluster(i, len(one.cpus), smem, one) for i, one in numbered))


def machine_clusters() -> tuple[HostCluster, ...]:
    """Return the clusters of this machine, with the CPUs that this process may use."""
    return clusters_of(read_cpus(), {*usable_cpus(), *isolated_cpus()})


def platforms_directory() -> Path:
    """Return the directory of this user's platforms; must match UserDirectory in C++."""
    return Path(os.environ.get("MANYCORE_DIRECTORY") or f"/dev/shm/manycore-{os.geteuid()}")


def shared_memory_place() -> Path:
    """Return an existing directory on the file system of the platforms.

    :raises ManycoreError: if $MANYCORE_DIRECTORY is not a directory.
    """
    chosen = os.environ.get("MANYCORE_DIRECTORY")
    if chosen and not Path(chosen).is_dir():
        is_missing = os.path.isabs(chosen) and not Path(chosen).exists()
        advice = f"`mkdir -p -m 700 {shlex.quote(chosen)}`" if is_missing else "choose another one"
        message = f"MANYCORE_DIRECTORY='{chosen}' is not a directory: {advice}"
        raise ManycoreError(message, EXIT_BAD_INPUT)
    return Path(chosen or "/dev/shm")


def host_smem_size(clusters: int) -> int:
    """Return the default local memory per cluster on this machine, a multiple of 1 MiB."""
    status = os.statvfs(shared_memory_place())
    return share_of_memory(status.f_blocks * status.f_frsize, clusters)


def share_of_memory(shared: int, clusters: int) -> int:
    """Return an equal share of half the memory; if it is small, clusters may overcommit."""
    common = min(shared // 4 * 3, 1024 * MIB) if shared else 1024 * MIB  # 0: no limit
    return max(shared // 2 // clusters, common, MIB) // MIB * MIB


def room_for_topic_dsms(smem_size: int) -> int:
    """Return the bytes of a cluster's memory available to topic DSMs, without control blocks."""
    return smem_size - min(smem_size // 8, 8 * MIB)


def usable_cpus() -> tuple[int, ...]:
    """Return the host CPUs this process may run on."""
    return tuple(sorted(os.sched_getaffinity(0)))


def isolated_cpus(system: Path = Path("/sys/devices/system/cpu")) -> tuple[int, ...]:
    """Return the isolated CPUs that this process may use.

    They are not in its affinity mask, and only in part in its cpuset.
    """
    try:
        isolated = cpus_of_list((system / "isolated").read_text())
    except OSError:
        return ()
    before = os.sched_getaffinity(0)
    return tuple(cpu for cpu in isolated if cpu in before or _may_run_on(cpu, before))


def _may_run_on(cpu: int, before: Collection[int]) -> bool:
    try:
        os.sched_setaffinity(0, {cpu})
    except OSError:  # not in the cpuset
        return False
    os.sched_setaffinity(0, before)
    return True


def as_host_cpu(cpus: tuple[int, ...]) -> HostCpu:
    """Return the affinity of a process for these CPUs; none mean all."""
    return cpus[0] if len(cpus) == 1 else cpus or None


def host_cpu_text(host_cpu: HostCpu) -> str:
    """Format an affinity for tables."""
    cpus = host_cpu if isinstance(host_cpu, tuple) else (host_cpu,)
    return "any" if host_cpu is None else ",".join(map(str, cpus))


def assign_host_cpus(
    used: Iterable[Core], fixed: Mapping[Core, int], cpus: Sequence[int]
) -> dict[Core, int]:
    """Distribute the used cores over the CPUs in order; none is shared while one is free.

    List the busiest cores first: nodes, then receive threads. Cores in `fixed` keep their CPU.
    """
    load = Counter(fixed.values())
    assigned = dict(fixed)
    for core in used:
        if core not in assigned:
            cpu = min(cpus, key=lambda candidate: load[candidate])
            assigned[core] = cpu
            load[cpu] += 1
    return assigned
