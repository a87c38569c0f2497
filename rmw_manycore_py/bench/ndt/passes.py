# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""Cost per point of one pass: search, score, gradient and Hessian."""

from __future__ import annotations

from pathlib import Path

from rmw_manycore_py.bench.ndt.contenders import (
    VOXEL_SIZE_M,
    map_for,
    on_cpu,
    one_level,
    profiler_of_each_kind,
    usable,
)
from rmw_manycore_py.bench.ndt.peers import Peer, all_peers
from rmw_manycore_py.bench.ndt.world import world
from rmw_manycore_py.bench.question import Measure, Question, Run
from rmw_manycore_py.bench.summary import Goal, Result
from rmw_manycore_py.native import _ndt_bench
from rmw_manycore_py.native.enums import Search, VoxelCovariance
from rmw_manycore_py.ndt import SerialMatcher

PASSES = 20
SCORE = "score, off the peer's"
# Search and covariance of each peer.
KINDS: dict[str, tuple[Search, VoxelCovariance]] = {
    "pclomp": ("direct7", "pclomp"),
    "PCL": ("radius", "pcl"),
}


def question(pclomp: Path | None) -> Question:
    """Return the question; includes pclomp if a checkout is given."""

    def measure(run: Run) -> list[Result]:
        cpu = usable()[-1]
        wanted = [name for name in KINDS if _wants_pass(run, name) or _wants_score(run, name)]
        with on_cpu(cpu), all_peers((cpu,), VOXEL_SIZE_M, pclomp, wanted) as peers:
            results = []
            for name, (search, covariance) in KINDS.items():
                results += _measure_kind(run, search, covariance, peers.get(name))
            for name, peer in peers.items():
                if _wants_score(run, name):
                    results.append(_compare(peer, *KINDS[name]))
            return results

    return Question("pass", measure, _goals(), "all contenders in turn on the last usable CPU")


def _wants_pass(run: Run, name: str) -> bool:
    return run.wants(f"{title(KINDS[name][0])}: {name}")


def _wants_score(run: Run, name: str) -> bool:
    return run.wants(f"{SCORE}: as {name}")


def title(search: Search) -> str:
    """Return the name of the question for a search."""
    return f"a pass by {search}, {VOXEL_SIZE_M:g} m"


def _goals() -> tuple[Goal, ...]:
    by_faces, by_radius = title("direct7"), title("radius")
    return (
        Goal(by_faces, "rmw_manycore avx512", "better", 50, "pclomp"),
        Goal(by_faces, "rmw_manycore portable", "better", 10, "pclomp"),
        Goal(by_radius, "rmw_manycore avx512", "better", 30, "PCL"),
        *(Goal(SCORE, f"as {name}", "within", 1000, statistic="largest") for name in KINDS),
    )


def _measure_kind(
    run: Run, search: Search, covariance: VoxelCovariance, peer: Peer | None
) -> list[Result]:
    options = one_level(search, covariance)
    voxel_map = map_for(options)
    contenders: dict[str, Measure] = {}
    for simd, profiler in profiler_of_each_kind(options).items():

        def own(profiler: _ndt_bench.Profiler = profiler) -> list[float]:
            found = []
            for scan, pose in zip(world().scans, world().poses, strict=True):
                passes = run.iterations(PASSES)
                times = profiler.time_passes_ns(voxel_map.finest, scan, pose, passes)
                found += [time_ns / len(scan) for time_ns in times]
            return found

        contenders[f"rmw_manycore {simd}"] = own
    if peer is not None:
        contenders[peer.name] = lambda: [
            peer.ask("evaluate", i)[0] / len(scan) for i, scan in enumerate(world().scans)
        ]
    return run.interleave(title(search), "ns/point", contenders)


def _compare(peer: Peer, search: Search, covariance: VoxelCovariance) -> Result:
    """Return the difference of the scores at the scans' poses from the peer's."""
    options = one_level(search, covariance)
    found = []
    with SerialMatcher(options) as matcher:
        matcher.set_map(map_for(options))
        for i, (scan, pose) in enumerate(zip(world().scans, world().poses, strict=True)):
            expected = peer.ask("evaluate", i)[1]
            found.append(1e6 * abs(matcher.score(scan, pose).score / expected - 1))
    return Result(SCORE, f"as {peer.name}", "ppm", tuple(found))
