# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""The project's matchers as contenders."""

from __future__ import annotations

import os
from collections.abc import Iterator
from contextlib import contextmanager

from rmw_manycore_py.native import _ndt, _ndt_bench
from rmw_manycore_py.native.enums import Search, VoxelCovariance
from rmw_manycore_py.ndt import MatcherOptions, VoxelMap
from rmw_manycore_py.ndt.matching.kernel_options import match_options

SIMD_VARIABLE = "MANYCORE_NDT_SIMD"
SIMDS = ("avx512", "avx2", "portable")
VOXEL_SIZE_M = 2.0


def one_level(
    search: Search = "direct7", covariance: VoxelCovariance = "autoware"
) -> MatcherOptions:
    """Return options for the work that PCL, pclomp and Autoware do per scan."""
    return MatcherOptions(
        voxel_size_m=VOXEL_SIZE_M,
        coarse_levels=(),
        search=search,
        voxel_covariance=covariance,
    )


def usable() -> list[int]:
    """Return the host CPUs this process may use."""
    return sorted(os.sched_getaffinity(0))


@contextmanager
def on_cpu(cpu: int) -> Iterator[None]:
    """Pin the calling thread to one CPU during the block."""
    before = os.sched_getaffinity(0)
    os.sched_setaffinity(0, {cpu})
    try:
        yield
    finally:
        os.sched_setaffinity(0, before)


def profiler_of_each_kind(options: MatcherOptions) -> dict[str, _ndt_bench.Profiler]:
    """Return a profiler per instruction set variant supported by this CPU."""
    before = os.environ.get(SIMD_VARIABLE)
    found = {}
    for simd in SIMDS:
        os.environ[SIMD_VARIABLE] = simd
        try:
            found[simd] = _ndt_bench.Profiler(match_options(options))
        except _ndt.NdtError:
            continue
    os.environ.pop(SIMD_VARIABLE)
    if before is not None:
        os.environ[SIMD_VARIABLE] = before
    return found


def map_for(options: MatcherOptions) -> VoxelMap:
    """Return the map of the world for these options."""
    from rmw_manycore_py.bench.ndt.world import world

    return VoxelMap.from_points(world().map_points, options)
