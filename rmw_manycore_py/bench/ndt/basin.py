# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""From how far off a scan finds home: with levels, with one, as Autoware, and multi-scale ICP."""

from __future__ import annotations

import time
from collections.abc import Callable
from contextlib import suppress
from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import ArrayLike

from rmw_manycore_py.bench.ndt.contenders import VOXEL_SIZE_M, map_for, on_cpu, usable
from rmw_manycore_py.bench.ndt.python_peer import open3d_multi_scale_aligner
from rmw_manycore_py.bench.ndt.world import World, world
from rmw_manycore_py.bench.question import Question, Run
from rmw_manycore_py.bench.summary import Goal, Result
from rmw_manycore_py.ndt import MatcherOptions, SerialMatcher
from rmw_manycore_py.ndt.geometry import poses
from rmw_manycore_py.ndt.geometry.arrays import Matrix

OFFSETS = ((0.5, 3.0), (1.0, 6.0), (2.0, 10.0), (3.0, 15.0), (5.0, 20.0))  # m, degrees
HOME_M, HOME_DEG = 0.2, 1.0
SCANS = 88
SEED = 3
ERROR_M, ERROR_DEG = 2.0, 10.0  # the offset whose results' errors are told
LEVELS, THREE_LEVELS, ONE_LEVEL = (
    f"rmw_manycore {words}" for words in ("4 m, 2 m", "8 m, 4 m, 2 m", "2 m alone")
)
AUTOWARE, ICP = "as Autoware", "Open3D, multi-scale ICP"

Align = Callable[[ArrayLike, Matrix], Matrix]


@dataclass(frozen=True)
class Found:
    """What came of each guess: error in metres and degrees, CPU time in ms."""

    error_m: tuple[float, ...]
    error_deg: tuple[float, ...]
    cpu_ms: tuple[float, ...]

    def is_home(self) -> tuple[float, ...]:
        """Return 100 for each result near the truth and 0 for the others."""
        errors = zip(self.error_m, self.error_deg, strict=True)
        return tuple(100.0 * (m < HOME_M and deg < HOME_DEG) for m, deg in errors)


def home_from(distance_m: float, angle_deg: float) -> str:
    """Return the name of the question how many scans find home."""
    return f"found from {distance_m:g} m, {angle_deg:g} degrees"


def cpu_from(distance_m: float, angle_deg: float) -> str:
    """Return the name of the question what that costs."""
    return f"CPU time from {distance_m:g} m, {angle_deg:g} degrees"


ERROR = f"error from {ERROR_M:g} m, {ERROR_DEG:g} degrees"


def measure(run: Run) -> list[Result]:
    """Return shares of scans that find home, on one CPU, and what they cost."""
    drive = world(run.iterations(SCANS))
    results = []
    with on_cpu(usable()[0]):
        for name, align in _contenders(run, drive).items():
            for offset in OFFSETS:
                run.note(f"{home_from(*offset)}: {name}")
                found = _found(align, drive, offset)
                home = Result(home_from(*offset), name, "%", found.is_home(), higher_is_better=True)
                results += [home, Result(cpu_from(*offset), name, "ms", found.cpu_ms)]
                if offset == (ERROR_M, ERROR_DEG):
                    errors_cm = tuple(100.0 * error_m for error_m in found.error_m)
                    results.append(Result(ERROR, name, "cm", errors_cm))
    return results


def _contenders(run: Run, drive: World) -> dict[str, Align]:
    found: dict[str, Align] = {}
    for name, options in _options().items():
        if run.wants(name):
            matcher = SerialMatcher(options)
            matcher.set_map(map_for(options))
            found[name] = _own(matcher)
    if run.wants(ICP):
        with suppress(ImportError):  # a peer that is not installed takes no part
            icp = open3d_multi_scale_aligner(drive.map_points.astype(np.float64))
            found[ICP] = lambda scan, guess: icp(np.asarray(scan, np.float64), guess)[1]
    return found


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
        LEVELS: base,
        THREE_LEVELS: replace(base, coarse_levels=(4.0, 2.0)),
        ONE_LEVEL: replace(base, coarse_levels=()),
        AUTOWARE: as_autoware,
    }


def _own(matcher: SerialMatcher) -> Align:
    return lambda scan, guess: matcher.align(scan, guess, only_pose=True).T_map_sensor


def _found(align: Align, drive: World, offset: tuple[float, float]) -> Found:
    generator = np.random.default_rng(SEED)
    distance_m, angle_deg = offset
    errors_m, errors_deg, times_ms = [], [], []
    for scan, truth in zip(drive.scans, drive.poses, strict=True):
        guess = poses.perturbed(truth, distance_m, float(np.radians(angle_deg)), generator)
        start = time.process_time()
        T = align(scan, guess)
        times_ms.append(1e3 * (time.process_time() - start))
        errors_m.append(poses.distance_m(T, truth))
        errors_deg.append(float(np.degrees(poses.angle_rad(T, truth))))
    return Found(tuple(errors_m), tuple(errors_deg), tuple(times_ms))


def _goals() -> tuple[Goal, ...]:
    return (
        Goal(home_from(2.0, 10.0), LEVELS, "better", 99.0, statistic="mean"),
        Goal(home_from(3.0, 15.0), LEVELS, "better", 95.0, statistic="mean"),
        Goal(home_from(5.0, 20.0), LEVELS, "better", 1.0, ICP, statistic="mean"),
        Goal(cpu_from(2.0, 10.0), LEVELS, "within", 1.0, ONE_LEVEL),
    )


QUESTION = Question("basin", measure, _goals(), "all contenders in turn on the first usable CPU")
