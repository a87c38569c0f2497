# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""Time per scan against the number of workers (ROS-lite2, Fig. 13), and beside other matchers."""

from __future__ import annotations

import time
from contextlib import ExitStack

from rmw_manycore_py import _ndt
from rmw_manycore_py.bench.ndt.contenders import VOXEL_SIZE_M, map_for, usable
from rmw_manycore_py.bench.ndt.peers import PYTHON_PEERS, Peer, all_peers
from rmw_manycore_py.bench.ndt.world import world
from rmw_manycore_py.bench.question import Measure, Question, Run
from rmw_manycore_py.bench.summary import Goal, Result
from rmw_manycore_py.ndt import MatcherOptions, SerialMatcher, WorkerMatcher
from rmw_manycore_py.ndt.matcher import Matcher, native_options

NAME = f"time per scan, direct7, {VOXEL_SIZE_M:g} m"
TAIL = "the same, as p99 / median"
MOST_WORKERS = 16
REPEATS = 20


def workers(count: int) -> str:
    """Return the name of the contender with so many workers."""
    return f"rmw_manycore {count} worker{'s' if count > 1 else ''}"


def measure(run: Run) -> list[Result]:
    """Return milliseconds per alignment from 0.44 m beside the scan's place."""
    options = MatcherOptions(voxel_size_m=VOXEL_SIZE_M)
    voxel_map = map_for(options)
    cpus = usable()
    with ExitStack() as stack:
        contenders: dict[str, Measure] = {}
        for count in range(1, min(len(cpus), MOST_WORKERS) + 1):
            matcher: Matcher = stack.enter_context(WorkerMatcher(options, cpus[:count]))
            matcher.set_map(voxel_map)
            contenders[workers(count)] = _own(run, matcher)
            threads = SerialMatcher(options)
            threads._native = _ndt.ThreadMatcher(native_options(options), cpus[:count], [])
            threads.set_map(voxel_map)
            contenders[f"{count} thread{'s' if count > 1 else ''}"] = _own(run, threads)
        names = [name for name in ("PCL", *PYTHON_PEERS) if run.wants(name)]
        peers = stack.enter_context(all_peers(cpus[0], VOXEL_SIZE_M, None, names))
        contenders.update({name: _peer(peer) for name, peer in peers.items()})
        results = run.interleave(NAME, "ms", contenders)
    return results + [_tail(result) for result in results if "rmw_manycore" in result.contender]


def _own(run: Run, matcher: Matcher) -> Measure:
    def measured() -> list[float]:
        times = []
        for _ in range(run.iterations(REPEATS)):
            for scan, guess in zip(world().scans, world().guesses, strict=True):
                start = time.perf_counter()
                matcher.align(scan, guess)
                times.append((time.perf_counter() - start) * 1e3)
        return times

    return measured


def _peer(peer: Peer) -> Measure:
    return lambda: [peer.ask("align", i)[0] / 1e6 for i in range(len(world().scans))]


def _tail(result: Result) -> Result:
    """Return p99 / median, scan by scan so that easy and hard scans do not count as jitter."""
    count = len(world().scans)
    ratios = []
    for scan in range(count):
        ordered = sorted(result.samples[scan::count])
        median = ordered[len(ordered) // 2]
        ratios.append(ordered[int(0.99 * (len(ordered) - 1))] / median)
    return Result(TAIL, result.contender, "x", tuple(ratios))


def _goals() -> tuple[Goal, ...]:
    return (
        Goal(NAME, workers(2), "better", 1.8, workers(1)),
        *(Goal(TAIL, workers(count), "within", 1.5) for count in (1, 2)),
    )


QUESTION = Question(
    "time per scan",
    measure,
    _goals(),
    "workers and threads on the first usable CPUs, peers on the first of them",
)
