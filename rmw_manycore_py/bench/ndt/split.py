# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""Search and derivatives on cores of their own (ROS-lite, Fig. 15), and what share each has."""

from __future__ import annotations

import time
from dataclasses import replace

from rmw_manycore_py import _ndt_bench
from rmw_manycore_py.bench.ndt.contenders import VOXEL_SIZE_M, map_for, on_cpu, one_level, usable
from rmw_manycore_py.bench.ndt.world import world
from rmw_manycore_py.bench.question import Measure, Question, Run
from rmw_manycore_py.bench.summary import Curve, Goal, Result
from rmw_manycore_py.ndt import MatcherOptions
from rmw_manycore_py.ndt.geometry.arrays import scan_points
from rmw_manycore_py.ndt.matching.kernel_options import match_options

SPLIT = f"search + derivatives apart, radius, {VOXEL_SIZE_M:g} m"
PROFILE = f"share of an alignment, radius, {VOXEL_SIZE_M:g} m"
PASSES = "search + derivatives, of the passes"
WHOLE = "both on all cores"
MOST_CORES = 8
MOST_FOR_SEARCH = 3
MOST_FOR_DERIVATIVES = 5
REPEATS = 5


def measure(run: Run) -> list[Result]:
    """Return milliseconds per scan for each way to divide the cores, and the profile."""
    options = one_level("radius")
    return _measure_split(run, options) + _measure_profile(run, options)


def _measure_split(run: Run, options: MatcherOptions) -> list[Result]:
    voxel_map = map_for(options)
    cpus = usable()[:MOST_CORES]
    contenders: dict[str, Measure] = {}
    curves: dict[str, Curve] = {}
    for derivatives, search in _ways(len(cpus)):
        name = f"{derivatives} for derivatives, {search} for the search" if search else WHOLE
        curve = f"{search} for the search, the others for derivatives" if search else WHOLE
        curves[f"rmw_manycore {name}"] = Curve(curve, derivatives + search)
        matcher = _ndt_bench.ThreadMatcher(
            match_options(options), cpus[:derivatives], cpus[derivatives : derivatives + search]
        )

        def aligned(matcher: _ndt_bench.ThreadMatcher = matcher) -> list[float]:
            times = []
            for _ in range(run.iterations(REPEATS)):
                for scan, guess in zip(world().scans, world().guesses, strict=True):
                    start = time.perf_counter()
                    matcher.align(voxel_map.levels, scan_points(scan), guess)
                    times.append((time.perf_counter() - start) * 1e3)
            return times

        contenders[f"rmw_manycore {name}"] = aligned
    return [
        replace(result, curve=curves[result.contender])
        for result in run.interleave(SPLIT, "ms", contenders)
    ]


def _ways(cores: int) -> list[tuple[int, int]]:
    """Return how many cores have the derivatives, and how many the search."""
    return [(cores, 0)] + [
        (derivatives, search)
        for search in range(1, MOST_FOR_SEARCH + 1)
        for derivatives in range(1, min(MOST_FOR_DERIVATIVES, cores - search) + 1)
    ]


def _measure_profile(run: Run, options: MatcherOptions) -> list[Result]:
    voxel_map = map_for(options)
    profiler = _ndt_bench.Profiler(match_options(options))
    shares: dict[str, list[float]] = {}
    with on_cpu(usable()[0]):
        for _ in range(run.iterations(REPEATS)):
            for scan, guess in zip(world().scans, world().guesses, strict=True):
                times = profiler.profile(voxel_map.finest, scan_points(scan), guess)
                for name, share in _shares(times).items():
                    shares.setdefault(name, []).append(100 * share)
    return [
        Result(PROFILE, name, "%", tuple(found), higher_is_better=True)
        for name, found in shares.items()
    ]


def _shares(times: _ndt_bench.Profile) -> dict[str, float]:
    """Return the shares of an alignment; ROS-lite2 (Fig. 9) has 99 % for search and derivatives."""
    both_ns = times.search_ns + times.derivatives_ns
    return {
        "laying out the scan": times.lay_out_ns / times.total_ns,
        "search": times.search_ns / times.total_ns,
        "derivatives": times.derivatives_ns / times.total_ns,
        "search + derivatives": both_ns / times.total_ns,
        PASSES: both_ns / (times.total_ns - times.lay_out_ns),
    }


QUESTION = Question(
    "search and derivatives",
    measure,
    (Goal(PROFILE, PASSES, "better", 99),),
    "threads on the first usable CPUs",
)
