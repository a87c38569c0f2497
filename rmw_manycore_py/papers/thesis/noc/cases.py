# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""Transfers that are measured: sizes, methods, memories and routes, and the names of results."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

from rmw_manycore_py.errors import EXIT_BAD_INPUT, ManycoreError
from rmw_manycore_py.prediction.bostan.dma import METHODS, Method
from rmw_manycore_py.prediction.bostan.memory import MEMORIES, MemoryKind
from rmw_manycore_py.prediction.bostan.packets import MAX_TRANSFER_BYTES
from rmw_manycore_py.prediction.bostan.transfers import FLOW_CONTROLS

SIZES = (100, 1_000, 10_000, 100_000, 1_000_000)
RUNS = 200  # of a round; the default is five rounds
OVERFLOW = "lost while four clusters write to IO DDR"
NO_FLOW_CONTROL, FLOW_CONTROL = FLOW_CONTROLS


@dataclass(frozen=True)
class Case:
    """One way to transfer data to a cluster."""

    method: Method
    source: MemoryKind
    route: str

    @property
    def name(self) -> str:
        """How results name it."""
        return f"{self.method} from {self.source}, {self.route}"


@dataclass(frozen=True)
class Setting:
    """The routes of a machine or of a model.

    `main` is the route from an I/O cluster that figures 4.6 and 4.7 show; from cluster to cluster
    there is `between`.
    """

    routes: tuple[str, ...]
    main: str
    between: str

    @property
    def cases(self) -> list[Case]:
        """All cases: each method from I/O memories by every route, and between clusters."""
        return [
            Case(method, source, route)
            for method in METHODS
            for source in MEMORIES
            for route in self.routes_from(source)
        ]

    def routes_from(self, source: MemoryKind) -> tuple[str, ...]:
        """Return the routes that start at a memory."""
        return (self.between,) if source == "CC SMEM" else self.routes


def checked_sizes(sizes: Sequence[int]) -> tuple[int, ...]:
    """Return the sizes in order, each once.

    :raises ManycoreError: when one is no transfer, or more than a cluster's memory.
    """
    for size in sizes:
        if not 1 <= size <= MAX_TRANSFER_BYTES:
            expected = f"1 to {MAX_TRANSFER_BYTES} bytes, the memory of a Bostan cluster"
            raise ManycoreError(f"--size {size}: expected {expected}", EXIT_BAD_INPUT)
    return tuple(sorted(set(sizes)))


def size_name(size_bytes: int) -> str:
    """Return a size as the thesis writes it: 100 B, 1 KB, 1 MB."""
    for unit, factor in (("MB", 1_000_000), ("KB", 1_000)):
        if size_bytes >= factor and size_bytes % factor == 0:
            return f"{size_bytes // factor} {unit}"
    return f"{size_bytes} B"


def question_of(size_bytes: int) -> str:
    """Return the name of the question about transfers of a size."""
    return f"transfer of {size_name(size_bytes)}"
