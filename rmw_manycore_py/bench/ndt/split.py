# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""Search and derivatives on cores of their own (ROS-lite, Fig. 15), and what share each has."""

from __future__ import annotations

import time

from rmw_manycore_py import _ndt
from rmw_manycore_py.bench.ndt.contenders import VOXEL_SIZE_M, map_for, on_cpu, usable
from rmw_manycore_py.bench.ndt.world import world
from rmw_manycore_py.bench.question import Measure, Question, Run
from rmw_manycore_py.bench.summary import Result
from rmw_manycore_py.ndt import MatcherOptions
from rmw_manycore_py.ndt.arrays import scan_points
from rmw_manycore_py.ndt.matcher import native_options

SPLIT = f"search + derivatives apart, radius, {VOXEL_SIZE_M:g} m"
PROFILE = f"share of an alignment, radius, {VOXEL_SIZE_M:g} m"
MOST_CORES = 8
REPEATS = 5


def measure(run: Run) -> list[Result]:
    """Return milliseconds per scan for each way to divide the cores, and the profile."""
    options = MatcherOptions(voxel_size_m=VOXEL_SIZE_M, search="radius")
    return _measure_split(run, options) + _measure_profile(run, options)


def _measure_split(run: Run, options: MatcherOptions) -> list[Result]:
    voxel_map = map_for(options)
    cpus = usable()[:MOST_CORES]
    ways: list[tuple[str, list[int], list[int]]] = [("both on all cores", cpus, [])]
    for derivatives in range(1, len(cpus)):
        name = f"{derivatives} for derivatives, {len(cpus) - derivatives} for the search"
        ways.append((name, cpus[:derivatives], cpus[derivatives:]))
    contenders: dict[str, Measure] = {}
    for name, own, searching in ways:
        matcher = _ndt.ThreadMatcher(native_options(options), own, searching)

        def aligned(matcher: _ndt.ThreadMatcher = matcher) -> list[float]:
            times = []
            for _ in range(run.iterations(REPEATS)):
                for scan, guess in zip(world().scans, world().guesses, strict=True):
                    start = time.perf_counter()
                    matcher.align(voxel_map.native, scan_points(scan), guess)
                    times.append((time.perf_counter() - start) * 1e3)
            return times

        contenders[f"rmw_manycore {name}"] = aligned
    return run.interleave(SPLIT, "ms", contenders)


def _measure_profile(run: Run, options: MatcherOptions) -> list[Result]:
    voxel_map = map_for(options)
    matcher = _ndt.SerialMatcher(native_options(options))
    shares: dict[str, list[float]] = {"search": [], "derivatives": [], "both": []}
    with on_cpu(usable()[0]):
        for _ in range(run.iterations(REPEATS)):
            for scan, guess in zip(world().scans, world().guesses, strict=True):
                times = matcher.profile_ns(voxel_map.native, scan_points(scan), guess)
                matching_ns = times["total"] - times["lay_out"]
                for name in ("search", "derivatives"):
                    shares[name].append(100 * times[name] / matching_ns)
                both = times["search"] + times["derivatives"]
                shares["both"].append(100 * both / matching_ns)
    return [
        Result(PROFILE, name, "%", tuple(found), higher_is_better=True)
        for name, found in shares.items()
    ]


QUESTION = Question(
    "search and derivatives",
    measure,
    (),
    "threads on the first usable CPUs",
)
