# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""Search and derivatives on separate cores (ROS-lite, Fig. 15), and the share of each."""

from __future__ import annotations

import time
from collections.abc import Callable
from dataclasses import replace

from rmw_manycore_py.bench.ndt.contenders import VOXEL_SIZE_M, map_for, on_cpu, one_level, usable
from rmw_manycore_py.bench.ndt.world import world
from rmw_manycore_py.bench.question import Measure, Question, Run
from rmw_manycore_py.bench.summary import Curve, Goal, Result
from rmw_manycore_py.native import _ndt_bench
from rmw_manycore_py.ndt import MatcherOptions
from rmw_manycore_py.ndt.geometry.arrays import scan_points
from rmw_manycore_py.ndt.matching.kernel_options import match_options

SPLIT = f"search + derivatives apart, radius, {VOXEL_SIZE_M:g} m"
PROFILE = f"share of an alignment, radius, {VOXEL_SIZE_M:g} m"
PASSES = "search + derivatives, of the passes"
WHOLE = "both on all cores"
MAX_CORES = 8
MAX_FOR_SEARCH = 3
MAX_FOR_DERIVATIVES = 5
REPEATS = 5


def measure(run: Run) -> list[Result]:
    """Return milliseconds per scan for each partition of the cores, and the profile."""
    options = one_level("radius")
    return _measure_split(run, options) + _measure_profile(run, options)


def _measure_split(run: Run, options: MatcherOptions) -> list[Result]:
    voxel_map = map_for(options)
    cpus = usable()[:MAX_CORES]
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
    """Return pairs of numbers of cores, for derivatives and for the search."""
    return [(cores, 0)] + [
        (derivatives, search)
        for search in range(1, MAX_FOR_SEARCH + 1)
        for derivatives in range(1, min(MAX_FOR_DERIVATIVES, cores - search) + 1)
    ]


def _measure_profile(run: Run, options: MatcherOptions) -> list[Result]:
    shares: dict[str, list[float]] = {
        name: [] for name in SHARES if run.wants(f"{PROFILE}: {name}")
    }
    if not shares:
        return []
    voxel_map = map_for(options)
    profiler = _ndt_bench.Profiler(match_options(options))
    with on_cpu(usable()[0]):
        for _ in range(run.iterations(REPEATS)):
            for scan, guess in zip(world().scans, world().guesses, strict=True):
                times = profiler.profile(voxel_map.finest, scan_points(scan), guess)
                for name, found in shares.items():
                    found.append(100 * SHARES[name](times))
    return [
        Result(PROFILE, name, "%", tuple(found), higher_is_better=True)
        for name, found in shares.items()
    ]


def _both_ns(times: _ndt_bench.Profile) -> float:
    return times.search_ns + times.derivatives_ns


# Shares of an alignment; ROS-lite2 (Fig. 9): 99 % for search and derivatives.
SHARES: dict[str, Callable[[_ndt_bench.Profile], float]] = {
    "laying out the scan": lambda times: times.lay_out_ns / times.total_ns,
    "search": lambda times: times.search_ns / times.total_ns,
    "derivatives": lambda times: times.derivatives_ns / times.total_ns,
    "search + derivatives": lambda times: _both_ns(times) / times.total_ns,
    PASSES: lambda times: _both_ns(times) / (times.total_ns - times.lay_out_ns),
}


QUESTION = Question(
    "search and derivatives",
    measure,
    (Goal(PROFILE, PASSES, "better", 99),),
    "threads on the first usable CPUs",
)
