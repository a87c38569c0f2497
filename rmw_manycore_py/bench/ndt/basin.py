# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""Convergence basin: second looks, levels, one level, Autoware's options, multi-scale ICP."""

from __future__ import annotations

import time
from collections.abc import Callable, Mapping, Sequence
from contextlib import suppress
from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import ArrayLike

from rmw_manycore_py.bench.ndt.contenders import VOXEL_SIZE_M, on_cpu, usable
from rmw_manycore_py.bench.ndt.python_peer import open3d_multi_scale_aligner
from rmw_manycore_py.bench.ndt.trust_worlds import simulated
from rmw_manycore_py.bench.ndt.world import RecordedWorld, world
from rmw_manycore_py.bench.question import Question, Run
from rmw_manycore_py.bench.summary import Goal, Result
from rmw_manycore_py.ndt import MatcherOptions, SerialMatcher, VoxelMap
from rmw_manycore_py.ndt.geometry import poses
from rmw_manycore_py.ndt.geometry.arrays import Matrix, Points

FAR, FARTHEST = (5.0, 20.0), (8.0, 45.0)  # m, degrees
OFFSETS = ((0.5, 3.0), (1.0, 6.0), (2.0, 10.0), (3.0, 15.0), FAR, FARTHEST)
FAR_OFFSETS = OFFSETS[2:]
HOME_M, HOME_DEG = 0.2, 1.0
SCANS = 88
DIRECTIONS = 4  # guesses from each scan and distance
STREETS = ("street 1", "street 2", "street, sparse map")
SEED = 3
ERROR_M, ERROR_DEG = 2.0, 10.0  # offset for which errors are reported
SECOND_LOOK, BY_FACES, LEVELS, THREE_LEVELS, ONE_LEVEL = (
    f"rmw_manycore {words}"
    for words in ("second look", "second look, direct7", "4 m, 2 m", "8 m, 4 m, 2 m", "2 m alone")
)
AUTOWARE, ICP = "as Autoware", "Open3D, multi-scale ICP"

Align = Callable[[ArrayLike, Matrix], Matrix]


@dataclass(frozen=True)
class Place:
    """World to register in: a map, and scans (n, 3) with their poses T_map_sensor.

    :param name: "" for the recorded drive.
    """

    name: str
    map_points: Points
    scans: Sequence[Points]
    truths: Sequence[Matrix]


@dataclass(frozen=True)
class Found:
    """Result from one guess: error in metres and degrees, CPU time in ms."""

    error_m: tuple[float, ...]
    error_deg: tuple[float, ...]
    cpu_ms: tuple[float, ...]

    def is_home(self) -> tuple[float, ...]:
        """Return 100 for each result near the truth and 0 for the others."""
        errors = zip(self.error_m, self.error_deg, strict=True)
        return tuple(100.0 * (m < HOME_M and deg < HOME_DEG) for m, deg in errors)


def home_from(distance_m: float, angle_deg: float, place: str = "") -> str:
    """Return the name of the question on the share of scans that converge."""
    return f"found from {distance_m:g} m, {angle_deg:g} degrees{_in(place)}"


def cpu_from(distance_m: float, angle_deg: float, place: str = "") -> str:
    """Return the name of the question on its CPU time."""
    return f"CPU time from {distance_m:g} m, {angle_deg:g} degrees{_in(place)}"


def _in(place: str) -> str:
    return f": {place}" if place else ""


ERROR = f"error from {ERROR_M:g} m, {ERROR_DEG:g} degrees"


def measure(run: Run) -> list[Result]:
    """Return shares of scans that converge and their CPU time, on one CPU."""
    results = []
    with on_cpu(usable()[0]):
        drive = recorded_drive(run.iterations(SCANS))
        for name in (SECOND_LOOK, BY_FACES, LEVELS, THREE_LEVELS, ONE_LEVEL, AUTOWARE, ICP):
            results += _results(run, drive, name, OFFSETS)
        for name_of_street in STREETS:
            names = (SECOND_LOOK, BY_FACES, LEVELS, ICP)
            contenders = [name for name in names if _wants(run, name)]
            place = street(name_of_street, run.iterations(SCANS)) if contenders else drive
            for name in contenders:
                results += _results(run, place, name, FAR_OFFSETS)
    return results


def _results(
    run: Run, place: Place, name: str, offsets: Sequence[tuple[float, float]]
) -> list[Result]:
    align = contender(name, place) if _wants(run, name) else None
    if align is None:
        return []
    results = []
    for offset in offsets:
        question = home_from(*offset, place.name)
        run.note(f"{question}: {name}")
        one = outcome(align, place, offset)
        results.append(Result(question, name, "%", one.is_home(), higher_is_better=True))
        results.append(Result(cpu_from(*offset, place.name), name, "ms", one.cpu_ms))
        if offset == (ERROR_M, ERROR_DEG):
            errors_cm = tuple(100.0 * error_m for error_m in one.error_m)
            results.append(Result(f"{ERROR}{_in(place.name)}", name, "cm", errors_cm))
    return results


def _wants(run: Run, name: str) -> bool:
    return run.wants(f"{QUESTION.name}: {name}")


def recorded_drive(scans: int, first: int = 0, step: int = 2) -> Place:
    """Return the recorded drive, or a simulated one where there is no recording.

    :param first: of the even scans that the map is made of; `step` from one to the next.
    """
    return place_of(world(scans, first, step))


def place_of(recorded: RecordedWorld) -> Place:
    """Return map and scans of a recording."""
    return Place("", recorded.map_points, recorded.scans, list(recorded.poses))


def street(name: str, scans: int) -> Place:
    """Return a simulated street, whose poses are exact."""
    drive = simulated()[name]()
    tested = drive.tested[:: max(1, len(drive.tested) // scans)]
    clouds = [drive.scan(index) for index in tested]
    return Place(name, drive.map_points, clouds, [drive.poses[index] for index in tested])


def contender(
    name: str, place: Place, options: Mapping[str, MatcherOptions] | None = None
) -> Align | None:
    """Return what aligns; None for a peer that is not installed.

    :param options: of the contenders that are the project's own; None: those of this question.
    """
    if name == ICP:
        with suppress(ImportError):
            icp = open3d_multi_scale_aligner(place.map_points.astype(np.float64))
            return lambda scan, guess: icp(np.asarray(scan, np.float64), guess)[1]
        return None
    chosen = (options or _options())[name]
    matcher = SerialMatcher(chosen)
    matcher.set_map(VoxelMap.from_points(place.map_points, chosen))
    return lambda scan, guess: matcher.align(scan, guess, only_pose=True).T_map_sensor


def _options() -> dict[str, MatcherOptions]:
    base = MatcherOptions(voxel_size_m=VOXEL_SIZE_M, search="radius")
    as_autoware = MatcherOptions(
        voxel_size_m=VOXEL_SIZE_M,
        coarse_levels=(),
        search="radius",
        voxel_covariance="autoware",
        step_rule="clamped",
    )
    return {
        SECOND_LOOK: base,
        BY_FACES: replace(base, search="direct7"),
        LEVELS: replace(base, wide_levels=()),
        THREE_LEVELS: replace(base, coarse_levels=(4.0, 2.0), wide_levels=()),
        ONE_LEVEL: replace(base, coarse_levels=()),
        AUTOWARE: as_autoware,
    }


def outcome(align: Align, place: Place, offset: tuple[float, float]) -> Found:
    """Return what the scans of a place give from guesses that are metres and degrees off."""
    generator = np.random.default_rng(SEED)
    distance_m, angle_deg = offset
    errors_m, errors_deg, times_ms = [], [], []
    for _ in range(DIRECTIONS):
        for scan, truth in zip(place.scans, place.truths, strict=True):
            guess = poses.perturbed(truth, distance_m, float(np.radians(angle_deg)), generator)
            start = time.process_time()
            T = align(scan, guess)
            times_ms.append(1e3 * (time.process_time() - start))
            errors_m.append(poses.distance_m(T, truth))
            errors_deg.append(float(np.degrees(poses.angle_rad(T, truth))))
    return Found(tuple(errors_m), tuple(errors_deg), tuple(times_ms))


def _goals() -> tuple[Goal, ...]:
    return (
        Goal(home_from(2.0, 10.0), SECOND_LOOK, "better", 99.0, statistic="mean"),
        Goal(home_from(3.0, 15.0), SECOND_LOOK, "better", 95.0, statistic="mean"),
        Goal(home_from(*FAR), SECOND_LOOK, "better", 1.0, ICP, statistic="mean"),
        *(
            Goal(home_from(*FAR, street), SECOND_LOOK, "better", 1.0, ICP, statistic="mean")
            for street in STREETS
        ),
        *(
            Goal(home_from(*FARTHEST, place), SECOND_LOOK, "better", 95.0, statistic="mean")
            for place in ("", *STREETS)
        ),
        Goal(cpu_from(2.0, 10.0), SECOND_LOOK, "within", 1.0, ONE_LEVEL),
    )


QUESTION = Question("basin", measure, _goals(), "all contenders in turn on the first usable CPU")
