# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""Finding a scan in a map of 500 m by 500 m without a guess; only gravity is known.

The town is simulated. Recorded scans are searched in it too: their drive's map takes the place of
some of its blocks. Scans of another town are at no place of the map.
"""

from __future__ import annotations

import time
from collections.abc import Iterator, Sequence
from dataclasses import dataclass, replace

import numpy as np

from rmw_manycore_py.bench.ndt import town
from rmw_manycore_py.bench.ndt.contenders import usable
from rmw_manycore_py.bench.ndt.world import world
from rmw_manycore_py.bench.question import Question, Run
from rmw_manycore_py.bench.summary import Goal, Result
from rmw_manycore_py.ndt import Matcher, MatcherOptions, VoxelMap
from rmw_manycore_py.ndt.geometry import poses
from rmw_manycore_py.ndt.geometry.arrays import Matrix, Points, Pose, ScanPoints, scan_points
from rmw_manycore_py.ndt.matching.worker_matcher import WorkerMatcher
from rmw_manycore_py.ndt.trust.score_level import ScoreLevel
from rmw_manycore_py.ndt.trust.search import Region, search
from rmw_manycore_py.process.cpu_time import process_cpu_s

OURS = "rmw_manycore"
RIGHT, WRONG = "scans found at their place", "scans found elsewhere"
FOREIGN = "scans of another town that are found"
CPU, BUSIEST = "CPU time of a search", "CPU time of its busiest process and the caller"
WALL = "time of a search"
PLACE = "town of 500 m"
RECORDED = f"recorded scans in the {PLACE}"
SCANS, RECORDED_SCANS, SHARED_SCANS = 200, 88, 20
SEED, OTHER_SEED = 1, 2
RIGHT_M, RIGHT_DEG = 0.3, 1.5
CLEARED_M = 15.0  # around the recorded drive's map
AT_M = (250.0, 250.0)  # where that is
OPTIONS = MatcherOptions(search="radius")  # the node's options


@dataclass(frozen=True)
class Lost:
    """A scan (N, 3) and its pose T_map_sensor, of which only the tilt is known."""

    scan: ScanPoints
    truth: Pose

    def region(self) -> Region:
        """Return the whole map, from its middle on."""
        roll, pitch, _ = poses.to_rpy(self.truth)
        centre = poses.from_xyz_rpy((*AT_M, 0.0), (roll, pitch, 0.0))
        return Region(centre, np.inf, any_yaw=True)

    def is_at(self, T: Pose) -> bool:
        """Return whether a pose is right."""
        turned_deg = np.degrees(poses.angle_rad(T, self.truth))
        return poses.distance_m(T, self.truth) < RIGHT_M and bool(turned_deg < RIGHT_DEG)


@dataclass(frozen=True)
class Search:
    """Outcome of a search, and seconds: CPU time of all processes and of the busiest, duration."""

    found: Pose | None
    cpu_s: float
    busiest_s: float
    wall_s: float


def searched(matcher: Matcher, lost: Lost) -> Search:
    """Search for a scan in the whole map."""
    level = ScoreLevel()
    level.map_changed(matcher.map.own_score)
    begin_s, own_s = time.perf_counter(), time.process_time()
    before_s = [process_cpu_s(pid) for pid in matcher.worker_pids]
    region = lost.region()
    found = search(matcher, lost.scan, region)
    after_s = [process_cpu_s(pid) for pid in matcher.worker_pids]
    workers_s = [after - before for after, before in zip(after_s, before_s, strict=True)]
    own_s, wall_s = time.process_time() - own_s, time.perf_counter() - begin_s
    T = None if found.why_unclear(level, region) else found.places[0].T_map_sensor
    return Search(T, own_s + sum(workers_s), own_s + max(workers_s), wall_s)


def in_town(seed: int, count: int) -> Iterator[Lost]:
    """Yield scans of a town from random places on its streets."""
    generator = np.random.default_rng((seed, 7))
    for T in town.places(count, generator):
        yield Lost(scan_points(town.LIDAR.scan(town.build_town(seed), T, generator)), T)


def recorded_in(points: Points, count: int) -> tuple[Points, list[Lost]]:
    """Return a town's map with a recorded drive in its middle, and scans of that."""
    drive = world(count)
    ground_m = np.quantile(drive.map_points[:, 2], 0.1)
    shift = np.array([*AT_M, 0.0]) - [*np.median(drive.map_points[:, :2], axis=0), ground_m]
    low, high = drive.map_points.min(axis=0) + shift, drive.map_points.max(axis=0) + shift
    inside = (points[:, :2] > low[:2] - CLEARED_M) & (points[:, :2] < high[:2] + CLEARED_M)
    joined = np.concatenate([points[~inside.all(axis=1)], drive.map_points + shift])
    moved = [_moved(T, shift) for T in drive.poses]
    lost = [Lost(scan_points(scan), T) for scan, T in zip(drive.scans, moved, strict=True)]
    return joined.astype(np.float32), lost


def _moved(T: Pose, shift: Matrix) -> Pose:
    moved: Pose = T.copy()
    moved[:3, 3] += shift
    return moved


def measure(run: Run) -> list[Result]:
    """Return shares of scans found, and times."""
    parts = {PLACE: _in_town, BUSIEST: _shared, RECORDED: _beside}
    wanted = {name: part for name, part in parts.items() if run.wants(f"{QUESTION.name}: {name}")}
    if not wanted:
        return []
    run.note(f"{QUESTION.name}: map")
    points = town.survey(town.build_town(SEED), SEED)
    results: list[Result] = []
    for name, part in wanted.items():
        run.note(f"{QUESTION.name}: {name}")
        results += part(run, points)
    return [one for one in results if one.samples]


def _matcher(points: Points, cpus: Sequence[int]) -> WorkerMatcher:
    matcher = WorkerMatcher(OPTIONS, cpus)
    matcher.set_map(VoxelMap.from_points(points, OPTIONS))
    return matcher


def _in_town(run: Run, points: Points) -> list[Result]:
    with _matcher(points, usable()) as matcher:
        own = list(in_town(SEED, run.iterations(SCANS)))
        outcomes = [searched(matcher, one) for one in own]
        run.note(f"{QUESTION.name}: {FOREIGN}")
        others = [searched(matcher, one) for one in in_town(OTHER_SEED, run.iterations(SCANS) // 2)]
    found = _share(f"{FOREIGN}: {PLACE}", [o.found is not None for o in others])
    return [*_outcomes(PLACE, own, outcomes), found]


def _shared(run: Run, points: Points) -> list[Result]:
    """Search with one worker and with all, scan by scan: the speed of a host's CPUs changes."""
    with _matcher(points, usable()[:1]) as alone, _matcher(points, usable()) as shared:
        matchers = {"1 worker": alone, f"{len(usable())} workers": shared}
        found: dict[str, list[Search]] = {name: [] for name in matchers}
        for lost in in_town(SEED, run.iterations(SHARED_SCANS)):
            for name, matcher in matchers.items():
                found[name].append(searched(matcher, lost))
    return [
        Result(question, name, "s", tuple(getattr(one, field) for one in searches))
        for question, field in ((BUSIEST, "busiest_s"), (WALL, "wall_s"))
        for name, searches in found.items()
    ]


def _beside(run: Run, points: Points) -> list[Result]:
    joined, lost = recorded_in(points, run.iterations(RECORDED_SCANS))
    with _matcher(joined, usable()) as matcher:
        outcomes = [searched(matcher, one) for one in lost]
    return [*_outcomes(RECORDED, lost, outcomes)]


def _outcomes(place: str, lost: Sequence[Lost], outcomes: Sequence[Search]) -> Iterator[Result]:
    pairs = list(zip(lost, outcomes, strict=True))
    is_right = [o.found is not None and one.is_at(o.found) for one, o in pairs]
    is_wrong = [o.found is not None and not one.is_at(o.found) for one, o in pairs]
    found = _share(f"{RIGHT}: {place}", is_right)
    yield replace(found, higher_is_better=True)
    yield _share(f"{WRONG}: {place}", is_wrong)
    yield Result(f"{CPU}: {place}", OURS, "s", tuple(o.cpu_s for o in outcomes))


def _share(question: str, is_so: Sequence[bool]) -> Result:
    return Result(question, OURS, "%", tuple(100.0 * one for one in is_so))


def _goals() -> Iterator[Goal]:
    for place in (PLACE, RECORDED):
        yield Goal(f"{RIGHT}: {place}", OURS, "better", 99.0, statistic="mean")
        yield Goal(f"{WRONG}: {place}", OURS, "within", 0.0, statistic="mean")
        yield Goal(f"{CPU}: {place}", OURS, "within", 30.0, statistic="largest")
    yield Goal(f"{FOREIGN}: {PLACE}", OURS, "within", 0.0, statistic="mean")
    yield Goal(BUSIEST, "2 workers", "better", 1.8, "1 worker")


QUESTION = Question("lost", measure, tuple(_goals()), "workers on all usable CPUs")
