# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""Writes the sysfs tree of a machine from a short description.

One fact per line; `#` begins a comment:

    cores 0-27                  CPUs that are the first hardware thread of their core
    threads 28-55               second hardware threads, in the order of the cores
    package 0 0-27              socket of these cores
    node 0 0-27                 NUMA node of these cores; without cores: memory alone
    capacity 397 0-3            of these cores
    cache 3 Unified 16384K 7    level, type, size, and how many cores in a row share it
    cluster 2                   cores in a row that form a cluster; several numbers: in turn

The machines of this package are written from published facts.
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Sequence
from itertools import cycle
from pathlib import Path

from rmw_manycore_py.platform.machine.clusters import HostCluster, clusters_of
from rmw_manycore_py.platform.machine.sysfs import cpus_of_list, list_of_cpus, read_cpus

MACHINES = Path(__file__).with_name("machines")


class _Machine:
    def __init__(self, description: str) -> None:
        lines = (line.partition("#")[0].split() for line in description.splitlines())
        self._facts = [line for line in lines if line]
        self.cores = cpus_of_list(self._of("cores")[0][0])
        threads = self._of("threads")
        more = cpus_of_list(threads[0][0]) if threads else ()
        self.threads = {core: (core,) for core in self.cores}
        if more:
            self.threads = {c: (c, t) for c, t in zip(self.cores, more, strict=True)}

    def files(self) -> Iterator[tuple[str, str]]:
        """Yield each file with its text."""
        yield "cpu/online", list_of_cpus(self._with_threads(self.cores))
        for core in self.cores:
            yield from self._of_each((core,), "topology/thread_siblings_list", self.threads[core])
        for kind, file in (
            ("package", "topology/physical_package_id"),
            ("capacity", "cpu_capacity"),
        ):
            for value, cores in self._of(kind):
                for cpu in self._with_threads(cpus_of_list(cores)):
                    yield f"cpu/cpu{cpu}/{file}", value
        for sizes in self._of("cluster"):
            for row in self._rows(tuple(map(int, sizes))):
                cpus = self._with_threads(row)
                yield from self._of_each(row, "topology/cluster_cpus_list", cpus)
        for index, (level, kind, size, shared) in enumerate(self._of("cache")):
            for row in self._rows((int(shared),)):
                cpus = self._with_threads(row)
                directory = f"cache/index{index}"
                yield from self._of_each(row, f"{directory}/shared_cpu_list", cpus)
                for name, text in (("level", level), ("type", kind), ("size", size)):
                    yield from self._of_each(row, f"{directory}/{name}", text)
        for number, *cores in self._of("node"):
            cpus = self._with_threads(cpus_of_list("".join(cores)))
            yield f"node/node{number}/cpulist", list_of_cpus(cpus)

    def _of(self, kind: str) -> list[list[str]]:
        return [words for name, *words in self._facts if name == kind]

    def _of_each(
        self, cores: Iterable[int], name: str, value: str | tuple[int, ...]
    ) -> Iterator[tuple[str, str]]:
        text = value if isinstance(value, str) else list_of_cpus(value)
        for cpu in self._with_threads(cores):
            yield f"cpu/cpu{cpu}/{name}", text

    def _with_threads(self, cores: Iterable[int]) -> tuple[int, ...]:
        return tuple(sorted(thread for core in cores for thread in self.threads[core]))

    def _rows(self, sizes: Sequence[int]) -> Iterator[tuple[int, ...]]:
        left = self.cores
        for size in cycle(sizes):
            if not left:
                return
            yield left[:size]
            left = left[size:]


def write_sysfs(description: str, system: Path) -> Path:
    """Write the files of a machine below `system`, as below /sys/devices/system; return it."""
    for name, text in _Machine(description).files():
        file = system / name
        file.parent.mkdir(parents=True, exist_ok=True)
        file.write_text(text + "\n")
    return system


def description_of(machine: str) -> str:
    """Return the description of one of the machines."""
    return (MACHINES / f"{machine}.txt").read_text()


def clusters_in(
    description: str, system: Path, usable: str | None = None
) -> tuple[HostCluster, ...]:
    """Return the clusters of a described machine, of which some CPUs may be used."""
    cpus = read_cpus(write_sysfs(description, system))
    return clusters_of(cpus, None if usable is None else cpus_of_list(usable))
