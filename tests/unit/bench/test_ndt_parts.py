# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""Parts that only benches of the scan matcher use do the matcher's work."""

from __future__ import annotations

import os

import numpy as np
import pytest

from rmw_manycore_py.bench.ndt import passes
from rmw_manycore_py.native import _ndt, _ndt_bench
from rmw_manycore_py.ndt import MatcherOptions
from rmw_manycore_py.ndt.geometry.arrays import map_points, scan_points
from rmw_manycore_py.ndt.matching.kernel_options import coarse_options, map_options, match_options

pytestmark = pytest.mark.unit

OPTIONS = match_options(MatcherOptions())
POINTS = np.random.default_rng(1).uniform((-20, -20, 0), (20, 20, 5), (20_000, 3))
SCAN = scan_points(POINTS[::10])
GUESS = np.eye(4)
GUESS[:3, 3] = 0.2, -0.1, 0.1


@pytest.fixture(scope="module")
def voxel_map() -> _ndt.VoxelMap:
    return _ndt.VoxelMap(map_points(POINTS), map_options(MatcherOptions()))


@pytest.mark.parametrize(("derivatives", "search"), [(1, 0), (2, 0), (1, 1), (2, 1)])
def test_threads_find_what_one_thread_finds(
    voxel_map: _ndt.VoxelMap, derivatives: int, search: int
) -> None:
    cpu = min(os.sched_getaffinity(0))
    threads = _ndt_bench.ThreadMatcher(OPTIONS, [cpu] * derivatives, [cpu] * search)
    alone = _ndt.SerialMatcher(OPTIONS)
    coarse = _ndt.VoxelMap(map_points(POINTS), coarse_options(MatcherOptions(), 2.0))
    levels = [coarse, voxel_map]
    expected, found = (m.align(levels, SCAN, GUESS) for m in (alone, threads))
    assert (found.outcome, found.iterations) == (expected.outcome, expected.iterations)
    assert found.pose.tolist() == expected.pose.tolist()
    assert found.at.hessian.tolist() == expected.at.hessian.tolist()


def test_the_parts_of_an_alignment_are_timed(voxel_map: _ndt.VoxelMap) -> None:
    profiler = _ndt_bench.Profiler(OPTIONS)
    assert len(profiler.time_passes_ns(voxel_map, SCAN, GUESS, 3)) == 3
    assert len(profiler.time_shares_ns(voxel_map, SCAN, GUESS, 4)) == 4
    times = profiler.profile(voxel_map, SCAN, GUESS)
    parts = (times.lay_out_ns, times.search_ns, times.derivatives_ns)
    assert min(parts) > 0
    assert sum(parts) <= times.total_ns


def test_errors_of_the_kernel_come_as_those_of_ndt(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv("MANYCORE_NDT_SIMD", "abacus")
    with pytest.raises(_ndt.NdtError, match="MANYCORE_NDT_SIMD"):
        _ndt_bench.Profiler(OPTIONS)


def test_a_pass_is_held_against_fifty_of_pclomp():
    goals = {(one.contender, one.peer): one.factor for one in passes.question(None).goals}
    assert goals["rmw_manycore avx512", "pclomp"] == 50
