# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""Drives for judging poses: all recordings available, and simulated misleading streets."""

from __future__ import annotations

import os
from collections.abc import Callable
from dataclasses import dataclass
from functools import partial
from pathlib import Path

import numpy as np

from rmw_manycore_py.bench.ndt.world import DATA_VARIABLE
from rmw_manycore_py.ndt import MatcherOptions
from rmw_manycore_py.ndt.files.unreadable import UNREADABLE
from rmw_manycore_py.ndt.geometry.arrays import Matrix, Points
from rmw_manycore_py.ndt.geometry.poses import transform
from rmw_manycore_py.ndt.recordings.recording import RECORDING_ARRAYS, load_recording
from rmw_manycore_py.ndt.simulation.drive import poses_along, scans_along
from rmw_manycore_py.ndt.simulation.lidar import Lidar
from rmw_manycore_py.ndt.simulation.street import Street, build_street

LENGTH_M = 120.0
LIDAR = Lidar(rings=32, azimuths=400)
STEP_M, PERIOD_S = 1.5, 0.1  # 15 m/s at 10 Hz
MAPPING_M, SPARSE_MAPPING_M = 4.0, 16.0  # distance between mapping scans
OPTIONS = MatcherOptions(search="radius")  # the node's options
CONSECUTIVE_S = 1.0  # maximum time between scans of a drive


@dataclass(frozen=True)
class Drive:
    """A map, and the scans of a drive that are not part of the map.

    :param poses: T_map_sensor (S, 4, 4) of all scans, including those of the map.
    :param stamps_s: (S) in seconds.
    :param tested: indices of the scans that may be judged.
    :param scan: returns the points (n, 3) of a scan.
    :param is_drive: the scans are consecutive, so that motion can be estimated.
    :param repeats: places cannot be told apart by a single scan.
    :param options: of map and matcher.
    """

    name: str
    map_points: Points
    poses: Matrix
    stamps_s: Matrix
    tested: list[int]
    scan: Callable[[int], Points]
    is_drive: bool
    repeats: bool = False
    options: MatcherOptions = OPTIONS


def drives() -> dict[str, Callable[[], Drive]]:
    """Return a factory for each drive, by name."""
    return {**_recorded(), **simulated()}


def _recorded() -> dict[str, Callable[[], Drive]]:
    checkout = Path(__file__).resolve().parents[3]
    directory = Path(os.environ.get(DATA_VARIABLE, checkout.parent / "shared" / "data"))
    found: dict[str, Callable[[], Drive]] = {}
    for path in sorted(directory.glob("*.npz")) if directory.is_dir() else ():
        if _scans_in(path) > 1:
            found[path.stem] = partial(_of_recording, path)
    return found


def _scans_in(path: Path) -> int:
    """Return the number of scans without reading them; 0 if the file is no recording."""
    try:
        with np.load(path, allow_pickle=False) as file:
            return len(file["offsets"]) - 1 if set(file.files) >= RECORDING_ARRAYS else 0
    except UNREADABLE:
        return 0


def _of_recording(path: Path) -> Drive:
    recording = load_recording(path)
    stamps_s = recording.times_s()
    return Drive(
        path.stem,
        recording.accumulated(range(0, len(recording), 2)).astype(np.float32),
        recording.poses,
        stamps_s,
        list(range(1, len(recording), 2)),
        recording.scan,
        len(recording) > 10 and float(np.median(np.diff(stamps_s))) < CONSECUTIVE_S,
    )


def simulated() -> dict[str, Callable[[], Drive]]:
    """Return a factory for each simulated drive, by name."""
    found: dict[str, Callable[[], Drive]] = {}
    for seed in (1, 2):
        found[f"street {seed}"] = partial(_in_street, f"street {seed}", seed)
    for period_m in (12.0, 20.0):
        name = f"street that repeats every {period_m:g} m"
        found[name] = partial(_in_repeating_street, name, period_m)
    found["tunnel"] = partial(_in_tunnel, "tunnel")
    sparse = "street, sparse map"
    found[sparse] = partial(_in_street, sparse, 5, SPARSE_MAPPING_M)
    return found


def _in_street(name: str, seed: int, mapping_m: float = MAPPING_M) -> Drive:
    generator = np.random.default_rng(seed)
    return _driven(name, build_street(LENGTH_M, generator), generator, mapping_m)


def _in_repeating_street(name: str, period_m: float) -> Drive:
    generator = np.random.default_rng(int(period_m))
    return _driven(name, repeating_street(period_m, generator), generator, repeats=True)


def _in_tunnel(name: str) -> Drive:
    return _driven(name, tunnel(), np.random.default_rng(5), repeats=True)


def repeating_street(period_m: float, generator: np.random.Generator) -> Street:
    """Return one section of a street, repeated."""
    one = build_street(period_m, generator)
    boxes = (one.lower[:, 0] >= 0.0) & (one.lower[:, 0] < period_m)
    uprights = (one.centres[:, 0] >= 0.0) & (one.centres[:, 0] < period_m)
    shifts = np.arange(-60.0 // period_m, (LENGTH_M + 60.0) // period_m + 1) * period_m

    def repeated(corners: Matrix) -> Matrix:
        along = np.zeros(corners.shape[1])
        along[0] = 1.0
        return np.concatenate([corners + shift * along for shift in shifts])

    return Street(
        repeated(one.lower[boxes]),
        repeated(one.upper[boxes]),
        repeated(one.centres[uprights]),
        np.tile(one.radii[uprights], len(shifts)),
        np.tile(one.heights[uprights], len(shifts)),
    )


def tunnel() -> Street:
    """Return a tube of 9 m by 5 m with the frame of a niche every 25 m."""
    half_m, end_m = 4.5, LENGTH_M + 60.0
    lower = [[-60.0, -half_m - 1, 0.0], [-60.0, half_m, 0.0], [-60.0, -half_m, 5.0]]
    upper = [[end_m, -half_m, 5.0], [end_m, half_m + 1, 5.0], [end_m, half_m, 6.0]]
    for x in np.arange(0.0, LENGTH_M, 25.0):
        lower.append([x, half_m - 0.4, 0.0])
        upper.append([x + 0.6, half_m, 2.2])
    return Street(np.array(lower), np.array(upper), np.zeros((0, 2)), np.zeros(0), np.zeros(0))


def _driven(
    name: str,
    street: Street,
    generator: np.random.Generator,
    mapping_m: float = MAPPING_M,
    *,
    repeats: bool = False,
) -> Drive:
    places = poses_along(np.arange(-8.0, LENGTH_M + 8.0, mapping_m), side_m=0.6)
    mapped = scans_along(street, places, LIDAR, generator)
    points = [transform(T, scan) for T, scan in zip(places, mapped, strict=True)]
    poses = poses_along(np.arange(1.3, LENGTH_M - 2.0, STEP_M))
    stamps_s: Matrix = np.arange(len(poses), dtype=np.float64) * PERIOD_S
    return Drive(
        name,
        np.concatenate(points).astype(np.float32),
        poses,
        stamps_s,
        list(range(3, len(poses))),
        lambda index: LIDAR.scan(street, poses[index], np.random.default_rng((11, index))),
        is_drive=True,
        repeats=repeats,
    )
