# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""What a product takes on the cores of one cluster of the model.

A row of A times a row of B transposed: two loads and a multiply-add for each term. Threads share
the rows of C. They are slowed by the latency of the memory that each waits for, or by the rate of
the memory that all share, whichever is more.
"""

from __future__ import annotations

import math
from functools import cache

from rmw_manycore_py.prediction.bostan.cache import Cache
from rmw_manycore_py.prediction.bostan.memory import Memory, MemoryKind, bytes_per_cycle
from rmw_manycore_py.prediction.bostan.parameters import (
    IO_CACHE_BYTES,
    IO_CACHE_WAYS,
    PE_CACHE_BYTES,
    PE_CACHE_WAYS,
    SMEM_BANK_BYTES_PER_CYCLE,
    Parameters,
)

FLOAT_BYTES = 4
DDR_BURST_BYTES = 64  # of a DDR3 channel, 64 bits wide
_WARM_UP_ROWS = 1


def product_cycles(
    shape: tuple[int, int, int], kind: MemoryKind, is_cached: bool, threads: int, p: Parameters
) -> float:
    """Return the cycles for (rows, columns, depth) of a product in a memory."""
    rows, columns, depth = shape
    memory = Memory(kind, p)
    misses = _misses_per_term(columns, depth, kind, threads, round(p.line_bytes))
    waits = misses * memory.line_load_cycles(p.line_bytes) if is_cached else 2 * memory.load_cycles
    of_a_thread = math.ceil(rows / threads) * columns * depth * (p.multiply_add_cycles + waits)
    moved = misses * p.line_bytes if is_cached else 2 * _access_bytes(kind)
    of_the_memory = rows * columns * depth * moved / bytes_per_cycle(kind, p)
    return max(of_a_thread, of_the_memory)


def _access_bytes(kind: MemoryKind) -> int:
    """Return what a load of a word occupies of the memory's rate."""
    return DDR_BURST_BYTES if kind == "IO DDR" else SMEM_BANK_BYTES_PER_CYCLE


@cache
def _misses_per_term(
    columns: int, depth: int, kind: MemoryKind, threads: int, line_bytes: int
) -> float:
    """Return the misses per multiply-add; I/O cores share a cache, each PE has its own."""
    is_io = kind != "CC SMEM"
    cores = threads if is_io else 1
    size_bytes = IO_CACHE_BYTES if is_io else PE_CACHE_BYTES
    data = Cache(size_bytes, IO_CACHE_WAYS if is_io else PE_CACHE_WAYS, line_bytes)
    row_bytes = depth * FLOAT_BYTES
    start_of_b = -(-row_bytes * cores * 2 // line_bytes) * line_bytes
    before = 0
    for turn in range(_WARM_UP_ROWS + 1):
        before = data.misses
        for j in range(columns):
            for offset in range(0, row_bytes, line_bytes):
                for core in range(cores):  # in step, each with a row of C of its own
                    data.load((turn * cores + core) * row_bytes + offset)
                    data.load(start_of_b + j * row_bytes + offset)
    return (data.misses - before) / (columns * depth * cores)
