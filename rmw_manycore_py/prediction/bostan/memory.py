# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""Memories: what a core waits for a load, and the rate at which DMA engines read and write."""

from __future__ import annotations

import math
from typing import Literal

from rmw_manycore_py.prediction.bostan.parameters import (
    BYTES_PER_LOAD,
    REFRESH_INTERVAL_S,
    REFRESH_S,
    SMEM_BANK_BYTES_PER_CYCLE,
    SMEM_BANKS,
    Parameters,
)

MemoryKind = Literal["IO DDR", "IO SMEM", "CC SMEM"]
MEMORIES: tuple[MemoryKind, ...] = ("IO DDR", "IO SMEM", "CC SMEM")


class Memory:
    """One memory, shared by all that use it: requests are served one after the other."""

    def __init__(self, kind: MemoryKind, parameters: Parameters, phase: float = 0.0) -> None:
        """`phase`: which part of a refresh interval has passed at cycle 0; only DDR refreshes."""
        self.kind = kind
        self.load_cycles = load_cycles(kind, parameters)
        self._bytes_per_cycle = bytes_per_cycle(kind, parameters)
        self._scatter_share = parameters.ddr_scatter_share if kind == "IO DDR" else 1.0
        self._interval = parameters.cycles(REFRESH_INTERVAL_S) if kind == "IO DDR" else math.inf
        self._refresh = parameters.cycles(REFRESH_S)
        self._phase = phase
        self._free = 0.0

    def read(self, now: float, size_bytes: int) -> float:
        """Return when a DMA engine that asked now has read that many consecutive bytes."""
        self._free = self._serve(now, size_bytes / self._bytes_per_cycle)
        return self._free + self.load_cycles

    def write(self, now: float, size_bytes: int) -> float:
        """Return when the payload of a packet that came now is written."""
        rate = self._bytes_per_cycle * self._scatter_share
        self._free = self._serve(now, size_bytes / rate)
        return self._free

    def line_load_cycles(self, line_bytes: float) -> float:
        """Return what a core waits for a cache line: its first word, then the others."""
        return self.load_cycles + line_bytes / BYTES_PER_LOAD - 1

    def _serve(self, now: float, duration: float) -> float:
        start = max(now, self._free)
        if math.isinf(self._interval):
            return start + duration
        into = (start + self._phase * self._interval) % self._interval
        if into < self._refresh:
            start += self._refresh - into
            into = self._refresh
        refreshes = math.floor((into + duration) / self._interval)
        return start + duration + refreshes * self._refresh


def load_cycles(kind: MemoryKind, parameters: Parameters) -> float:
    """Return what a core waits for a word."""
    return {
        "IO DDR": parameters.ddr_cycles,
        "IO SMEM": parameters.io_smem_cycles,
        "CC SMEM": parameters.cluster_smem_cycles,
    }[kind]


def bytes_per_cycle(kind: MemoryKind, parameters: Parameters) -> float:
    """Return the rate of consecutive reads; the banks of an SMEM work side by side."""
    if kind == "IO DDR":
        return parameters.ddr_bytes_per_s * parameters.cycle_s
    return SMEM_BANKS * SMEM_BANK_BYTES_PER_CYCLE
