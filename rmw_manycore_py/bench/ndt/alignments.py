# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""Time per scan over the number of workers (ROS-lite2, Fig. 13), and of other matchers."""

from __future__ import annotations

import time
from collections.abc import Sequence
from contextlib import ExitStack
from dataclasses import replace
from pathlib import Path
from typing import Any

from rmw_manycore_py.bench.ndt.apart import Align, apart, matchers_apart
from rmw_manycore_py.bench.ndt.contenders import VOXEL_SIZE_M, map_for, on_cpu, one_level, usable
from rmw_manycore_py.bench.ndt.peers import PYTHON_PEERS, Peer, all_peers
from rmw_manycore_py.bench.ndt.world import world
from rmw_manycore_py.bench.question import Measure, Question, Run
from rmw_manycore_py.bench.summary import Curve, Goal, Result
from rmw_manycore_py.native import _ndt_bench
from rmw_manycore_py.ndt import MatcherOptions, WorkerMatcher
from rmw_manycore_py.ndt.geometry.arrays import scan_points
from rmw_manycore_py.ndt.matching.kernel_options import match_options
from rmw_manycore_py.ndt.matching.matcher import Matcher

NAME = f"time per scan, direct7, {VOXEL_SIZE_M:g} m"
TAIL = "time per scan / median of that scan"
MIXED = "time per scan / median of all scans"
IMBALANCE = "largest share of a pass / mean share"
MAX_WORKERS = 16
REPEATS = 5
SHARE_REPEATS = 100
# What the workers of ROS-lite2 are held against (V-B, Fig. 13).
LAPTOP_THREADS = 4
LAPTOP = f"pclomp, {LAPTOP_THREADS} threads"
TURNS = 4  # per round; the speed of a host's CPUs may change within seconds


def workers(count: int) -> str:
    """Return the name of the contender with this many workers."""
    return f"rmw_manycore {count} worker{'s' if count > 1 else ''}"


def threads(count: int) -> str:
    """Return the name of the contender with this many threads."""
    return f"{count} thread{'s' if count > 1 else ''}"


def question(pclomp: Path | None) -> Question:
    """Return the question; includes pclomp if a checkout is given."""
    return Question(
        "time per scan",
        lambda run: _measure(run, pclomp),
        _goals(),
        "workers and threads on the first usable CPUs, pclomp on all, other peers on the first",
    )


def _measure(run: Run, pclomp: Path | None) -> list[Result]:
    """Return milliseconds per alignment from guesses 0.44 m off."""
    options = one_level()
    voxel_map = map_for(options)
    cpus = usable()
    often = replace(run, rounds=TURNS * run.rounds)
    with ExitStack() as stack:
        contenders: dict[str, Measure] = {}
        curves: dict[str, Curve] = {}
        for count in range(1, min(len(cpus), MAX_WORKERS) + 1):
            matcher: Matcher = stack.enter_context(WorkerMatcher(options, cpus[:count]))
            matcher.set_map(voxel_map)
            contenders[workers(count)] = _own(run, matcher.align)
            curves[workers(count)] = Curve("rmw_manycore workers", count)
            native: Any = _ndt_bench.ThreadMatcher(  # aligns, but searches no places
                match_options(options), cpus[:count], []
            )
            threaded = stack.enter_context(Matcher(options, native))
            threaded.set_map(voxel_map)
            contenders[threads(count)] = _own(run, threaded.align)
            curves[threads(count)] = Curve("threads", count)
            alone = stack.enter_context(matchers_apart(options, voxel_map, cpus[:count]))
            contenders[apart(count)] = _own(run, alone)
        names = [name for name in ("PCL", *PYTHON_PEERS) if run.wants(f"{NAME}: {name}")]
        peers = stack.enter_context(all_peers(cpus[:1], VOXEL_SIZE_M, None, names))
        contenders.update({name: _peer(peer) for name, peer in peers.items()})
        names = ["pclomp"] if run.wants(f"{NAME}: {LAPTOP}") else []
        laptop = all_peers(cpus, VOXEL_SIZE_M, pclomp, names, LAPTOP_THREADS)
        for peer in stack.enter_context(laptop).values():
            contenders[LAPTOP] = _peer(peer)
        results = [
            replace(result, curve=curves.get(result.contender))
            for result in often.interleave(NAME, "ms", contenders)
        ]
    own = [result for result in results if "rmw_manycore" in result.contender]
    return [*results, *map(_tail, own), *map(_mixed, own), *_imbalance(run, options)]


def _own(run: Run, align: Align) -> Measure:
    def measured() -> list[float]:
        times = []
        for _ in range(run.iterations(REPEATS)):
            for scan, guess in zip(world().scans, world().guesses, strict=True):
                start = time.perf_counter()
                align(scan, guess)
                times.append((time.perf_counter() - start) * 1e3)
        return times

    return measured


def _peer(peer: Peer) -> Measure:
    return lambda: [peer.ask("align", i)[0] / 1e6 for i in range(len(world().scans))]


def _tail(result: Result) -> Result:
    """Return each time divided by the median of its scan: the variation of identical work."""
    count = len(world().scans)
    medians = [_median(result.samples[scan::count]) for scan in range(count)]
    ratios = (time / medians[i % count] for i, time in enumerate(result.samples))
    return Result(TAIL, result.contender, "x", tuple(ratios))


def _mixed(result: Result) -> Result:
    """Return each time divided by the overall median: includes scans that need more passes."""
    median = result.summary.median
    return Result(MIXED, result.contender, "x", tuple(time / median for time in result.samples))


def _imbalance(run: Run, options: MatcherOptions) -> list[Result]:
    """Return the balance of a pass over 16 workers, with each share timed on one CPU."""
    if not run.wants(f"{IMBALANCE}: {workers(MAX_WORKERS)}"):
        return []
    voxel_map = map_for(options)
    profiler = _ndt_bench.Profiler(match_options(options))
    found = []
    with on_cpu(usable()[0]):
        for scan, pose in zip(world().scans, world().poses, strict=True):
            points = scan_points(scan)
            shares = [
                profiler.time_shares_ns(voxel_map.finest, points, pose, MAX_WORKERS)
                for _ in range(run.iterations(SHARE_REPEATS))
            ]
            # The minimum is the undisturbed time of a share.
            times = [min(share) for share in zip(*shares, strict=True)]
            found.append(max(times) * len(times) / sum(times))
    return [Result(IMBALANCE, workers(MAX_WORKERS), "x", tuple(found))]


def _median(samples: Sequence[float]) -> float:
    return sorted(samples)[len(samples) // 2]


def _goals() -> tuple[Goal, ...]:
    return (
        Goal(NAME, workers(2), "better", 1.8, workers(1)),
        Goal(NAME, workers(2), "better", 1.8, apart(2)),
        *(Goal(TAIL, workers(count), "within", 1.5, statistic="p99") for count in (1, 2)),
        Goal(NAME, workers(1), "better", 1, LAPTOP),
        Goal(IMBALANCE, workers(MAX_WORKERS), "within", 1.05),
    )
