# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""Claims of section 4.2 of the thesis about its figures, as functions of times."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Protocol

import numpy as np

from rmw_manycore_py.bench.relations import Claim, Found, side
from rmw_manycore_py.papers.thesis.matrix.cases import (
    CC_SMEM,
    IO_DDR,
    IO_SMEM,
    OFFLOAD,
    Case,
    Place,
    threads_of,
)

ALIKE = 1.1
FASTER = 1.02
LINEAR = (0.9, 1.15)  # of the number of threads
FOURFOLD = (3.0, 5.0)
NEAR_THE_FIT = 0.1


class Times(Protocol):
    """Median times of products; KeyError for what was not measured."""

    @property
    def sizes(self) -> tuple[int, ...]:
        """The sizes, smallest first."""

    @property
    def free_cores(self) -> int:
        """How many threads have a core each."""

    def ms(self, case: Case) -> float:
        """Return the time of a product."""

    def lost(self, place: Place) -> float:
        """Return the loss while four clusters write their tiles of C into a memory."""


def _in_one_place(times: Times, place: Place, is_cached: bool, threads: int = 1) -> float:
    return times.ms(Case(times.sizes[0], place, is_cached, threads))


def cached_alike(times: Times) -> Found:
    """M1, first half: with caches the memory does not matter."""
    found = [_in_one_place(times, place, True) for place in (IO_DDR, IO_SMEM, CC_SMEM)]
    ratio = max(found) / min(found)
    return side(ratio, max_value=ALIKE), f"slowest / fastest {ratio:.2f} on one thread"


def linear_in_threads(times: Times) -> Found:
    """M1, second half: twice the threads, half the time."""
    found = {
        f"{threads} threads, {place}, {'cached' if is_cached else 'uncached'}": alone
        / _in_one_place(times, place, is_cached, threads)
        / threads
        for place in (IO_DDR, IO_SMEM, CC_SMEM)
        for is_cached in (True, False)
        if (alone := _in_one_place(times, place, is_cached))
        for threads in threads_of(place)
        if 1 < threads <= times.free_cores
    }
    if not found:
        raise KeyError("free cores")
    least, most = min(found, key=found.__getitem__), max(found, key=found.__getitem__)
    low = side(found[least], min_value=LINEAR[0])
    return low or side(found[most], max_value=LINEAR[1]), (
        f"speed-up {found[least]:.2f} ({least}) to {found[most]:.2f} x threads ({most})"
    )


def uncached_ddr_fourfold(times: Times) -> Found:
    """M2: without a cache, DDR takes four times as long."""
    ratio = _in_one_place(times, IO_DDR, False) / _in_one_place(times, IO_DDR, True)
    return side(
        ratio, min_value=FOURFOLD[0], max_value=FOURFOLD[1]
    ), f"uncached / cached {ratio:.2f} in IO DDR"


def cluster_smem_faster(times: Times) -> Found:
    """M2: without a cache, the SMEM of a cluster beats that of an I/O subsystem."""
    ratio = _in_one_place(times, IO_SMEM, False) / _in_one_place(times, CC_SMEM, False)
    return side(ratio, min_value=FASTER), f"IO SMEM / CC SMEM {ratio:.2f}, uncached"


def uncached_cluster_faster(times: Times) -> Found:
    """M2: in a cluster the small cache costs more than it saves."""
    ratio = _in_one_place(times, CC_SMEM, True) / _in_one_place(times, CC_SMEM, False)
    return side(ratio, min_value=FASTER), f"cached / uncached {ratio:.2f} in CC SMEM"


def constant_overhead(times: Times) -> Found:
    """M3, first half: off-loaded, time is an overhead and a share per thread."""
    threads = [t for t in threads_of(OFFLOAD) if t == 1 or 4 * t <= times.free_cores]
    if len(threads) < 3:
        raise KeyError("free cores of four clusters")
    found = [times.ms(Case(times.sizes[0], OFFLOAD, False, t)) for t in threads]
    overhead_ms, error = fit_overhead(threads, found)
    in_words = f"overhead {overhead_ms:.3f} ms, fit within {error:.0%}"
    return side(overhead_ms, min_value=0) or side(error, max_value=NEAR_THE_FIT), in_words


def fit_overhead(threads: Sequence[int], ms: Sequence[float]) -> tuple[float, float]:
    """Fit ms = overhead + work / threads; return the overhead and the largest relative error."""
    unknowns = np.column_stack([np.ones(len(threads)), 1 / np.asarray(threads)])
    solution = np.linalg.lstsq(unknowns, np.asarray(ms), rcond=None)[0]
    errors = np.abs(unknowns @ solution - ms) / ms
    return float(solution[0]), float(errors.max())


def offload_beats_ddr(times: Times) -> Found:
    """M3, second half: four clusters beat the I/O cores, whose DDR is cached."""
    ratio = _advantage(times, times.sizes[0])
    return side(ratio, min_value=FASTER), f"IO DDR cached / off-loaded {ratio:.2f}, 4 threads"


def more_for_large(times: Times) -> Found:
    """M4: the larger the matrices, the more off-loading brings."""
    if len(times.sizes) < 2:
        raise KeyError("two sizes")
    small, large = (_advantage(times, n) for n in (times.sizes[0], times.sizes[-1]))
    return side(large / small, min_value=FASTER), f"advantage {small:.2f} and {large:.2f}"


def _advantage(times: Times, n: int) -> float:
    return times.ms(Case(n, IO_DDR, True, 4)) / times.ms(Case(n, OFFLOAD, False, 4))


def overflow(times: Times) -> Found:
    """M5: tiles of C written to DDR at once overflow FIFOs, to SMEM they do not."""
    ddr, smem = times.lost(IO_DDR), times.lost(IO_SMEM)
    return (1 if smem else side(ddr, min_value=1)), f"{ddr:g} lost to IO DDR, {smem:g} to IO SMEM"


_LOADS = ("multiply_add_cycles", "line_bytes", "cluster_smem_cycles", "io_smem_cycles")
_COMPUTE = (*_LOADS, "ddr_cycles")
_OFFLOAD = ("multiply_add_cycles", "line_bytes", "cluster_smem_cycles", "ddr_cycles")
_WRITES = ("fifo_flits", "header_flits", "ddr_bytes_per_s", "ddr_scatter_share")

CLAIMS: tuple[Claim[Times], ...] = (
    Claim("M1", "cached, DDR and both SMEM are alike", cached_alike, _COMPUTE),
    Claim("M1b", "time is linear in threads", linear_in_threads, (*_COMPUTE, "ddr_bytes_per_s")),
    Claim("M2", "uncached, DDR takes four times as long", uncached_ddr_fourfold, _COMPUTE),
    Claim("M2b", "uncached, CC SMEM is faster than IO SMEM", cluster_smem_faster, _LOADS),
    Claim("M2c", "CC SMEM is faster uncached than cached", uncached_cluster_faster, _LOADS),
    Claim("M3", "off-loading has a constant overhead", constant_overhead, _OFFLOAD),
    Claim("M3b", "off-loading beats IO DDR cached", offload_beats_ddr, _OFFLOAD),
    Claim("M4", "and more so for 640 KB", more_for_large, _OFFLOAD),
    Claim("M5", "C in DDR overflows FIFOs, in SMEM not", overflow, _WRITES),
)
