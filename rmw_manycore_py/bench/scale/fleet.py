# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""Hundreds of nodes: a process each as far as memory goes, composed beyond that."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from contextlib import contextmanager
from dataclasses import dataclass
from pathlib import Path

from rmw_manycore_py.bench.session import Process, Session
from rmw_manycore_py.errors import ManycoreError

MAX_PROCESSES = 500
# A process with one node takes 2 MiB of its own, on Fast DDS more.
BYTES_OF_PROCESS = 8 * 1024 * 1024
MEMORY_SHARE = 0.5  # of the available memory


@dataclass(frozen=True)
class Fleet:
    """Nodes 0 to `count` - 1, in processes with consecutive nodes."""

    count: int
    processes: Sequence[Process]
    shares: Sequence[int]

    @property
    def pids(self) -> list[int]:
        """Return the processes."""
        return [process.pid for process in self.processes]

    @contextmanager
    def required(self) -> Iterator[None]:
        """Report a process that ended early instead of the failure that followed from it."""
        try:
            yield
        except ManycoreError:
            for process in self.processes:
                process.raise_if_failed()
            raise

    def nodes_after(self, victims: int) -> int:
        """Return how many nodes are left without the first processes."""
        return sum(self.shares[victims:])


def shares(nodes: int) -> list[int]:
    """Return the number of nodes of each process; they differ by at most one."""
    processes = min(nodes, max_processes())
    return [nodes // processes + (i < nodes % processes) for i in range(processes)]


def max_processes() -> int:
    """Return how many processes a fleet has at most on this machine."""
    by_memory = int(MEMORY_SHARE * _available_bytes()) // BYTES_OF_PROCESS
    return max(1, min(MAX_PROCESSES, by_memory))


def _available_bytes() -> int:
    lines = Path("/proc/meminfo").read_text().splitlines()
    available = next(line for line in lines if line.startswith("MemAvailable"))
    return int(available.split()[1]) * 1024


def start(session: Session, count: int) -> Fleet:
    """Start a fleet; return once each topic has its subscription.

    Its processes are the parties from 0 on.
    """
    each = shares(count)
    firsts = [sum(each[:party]) for party in range(len(each))]
    processes = [
        session.native("fleet", party, first=first, nodes=nodes, all=count, period_ms=0)
        for party, (first, nodes) in enumerate(zip(firsts, each, strict=True))
    ]
    for process in processes:
        process.wait_until_ready()
    return Fleet(count, processes, each)
