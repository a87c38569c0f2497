# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""Reads CPUs, caches and NUMA nodes from sysfs (Documentation/ABI of the kernel)."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path

SYSTEM = Path("/sys/devices/system")
FULL_CAPACITY = 1024  # of the fastest CPU; kernels without cpu_capacity have equal CPUs
_UNITS = {"K": 1 << 10, "M": 1 << 20, "G": 1 << 30}


@dataclass(frozen=True)
class Cache:
    """A cache for data and the CPUs that share it."""

    level: int
    size_bytes: int
    cpus: frozenset[int]


@dataclass(frozen=True)
class Cpu:
    """An online CPU of the kernel: a core, or a hardware thread of one.

    :param number: as in `taskset`.
    :param threads: the hardware threads of its core.
    :param package: socket.
    :param node: NUMA node; None on kernels without NUMA.
    :param capacity: relative to the fastest CPU, which has 1024.
    :param siblings: CPUs of its cluster in the kernel's sense, such as those with a common snoop
        control unit; only itself where the kernel has none.
    :param cache: last-level cache; None where sysfs shows no caches.
    """

    number: int
    threads: tuple[int, ...]
    package: int = 0
    node: int | None = None
    capacity: int = FULL_CAPACITY
    siblings: frozenset[int] = frozenset()
    cache: Cache | None = None

    @property
    def thread(self) -> int:
        """Index among the hardware threads of its core, from 0."""
        return self.threads.index(self.number)


def read_cpus(system: Path = SYSTEM) -> tuple[Cpu, ...]:
    """Return the online CPUs in a sysfs tree, by number."""
    numbers = cpus_of_list(_text(system / "cpu/online"))
    nodes = _nodes(system)
    return tuple(_cpu(system / f"cpu/cpu{number}", number, nodes.get(number)) for number in numbers)


def cpus_of_list(text: str) -> tuple[int, ...]:
    """Parse a CPU list of the kernel: 0-2,5."""
    ends = [part.split("-") for part in text.strip().split(",") if part]
    return tuple(cpu for end in ends for cpu in range(int(end[0]), int(end[-1]) + 1))


def list_of_cpus(cpus: tuple[int, ...]) -> str:
    """Format CPUs as the kernel does: 0-2,5."""
    ranges: list[list[int]] = []
    for cpu in sorted(cpus):
        if ranges and cpu == ranges[-1][-1] + 1:
            ranges[-1][1:] = [cpu]
        else:
            ranges.append([cpu])
    return ",".join("-".join(map(str, one)) for one in ranges)


def _cpu(directory: Path, number: int, node: int | None) -> Cpu:
    topology = directory / "topology"
    return Cpu(
        number,
        cpus_of_list(_text(topology / "thread_siblings_list")) or (number,),
        int(_text(topology / "physical_package_id") or 0),
        node,
        int(_text(directory / "cpu_capacity") or FULL_CAPACITY),
        frozenset(cpus_of_list(_text(topology / "cluster_cpus_list")) or (number,)),
        max(_caches(directory), key=lambda cache: cache.level, default=None),
    )


def _caches(directory: Path) -> Iterator[Cache]:
    for index in directory.glob("cache/index[0-9]*"):
        if _text(index / "type") != "Instruction":
            cpus = frozenset(cpus_of_list(_text(index / "shared_cpu_list")))
            yield Cache(int(_text(index / "level")), _bytes(_text(index / "size")), cpus)


def _nodes(system: Path) -> dict[int, int]:
    return {
        cpu: int(directory.name[len("node") :])
        for directory in system.glob("node/node[0-9]*")
        for cpu in cpus_of_list(_text(directory / "cpulist"))
    }


def _bytes(size: str) -> int:
    return int(size.rstrip("KMG") or 0) * _UNITS.get(size[-1:], 1)


def _text(file: Path) -> str:
    """Return a value; empty where this kernel has none."""
    try:
        return file.read_text().strip()
    except OSError:
        return ""
