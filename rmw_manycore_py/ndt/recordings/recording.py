# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""A recorded drive: LiDAR scans with poses, as npz.

| array | shape | meaning |
|---|---|---|
| `points` | int16 (N, 3 or more), or floating point | times `scale_m`: metres in the sensor frame |
| `scale_m` | scalar; default 1 | |
| `offsets` | integer (S + 1) | scan i is `points[offsets[i]:offsets[i + 1]]` |
| `poses` | (S, 4, 4) or (S, 3, 4) | T_map_sensor of each scan |
| `stamps` | (S), or empty or missing | seconds, or another unit recognised by `recordings.stamps` |
| `times` | (N) floating point; optional | seconds from its scan's stamp to each point |
| `note` | text; optional | origin of the data |
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Any, Protocol

import numpy as np
import numpy.typing as npt

from rmw_manycore_py.errors import EXIT_BAD_INPUT, ManycoreError
from rmw_manycore_py.ndt.files.unreadable import UNREADABLE, why_no_arrays, why_unreadable
from rmw_manycore_py.ndt.geometry.arrays import Matrix, Points
from rmw_manycore_py.ndt.geometry.poses import rigid, transform
from rmw_manycore_py.ndt.geometry.precision import needs_doubles, why_coarse
from rmw_manycore_py.ndt.recordings.stamps import in_seconds

RECORDING_ARRAYS = frozenset(("points", "offsets", "poses"))  # required arrays
DEFAULT_SCALE_M = 0.002
DEFAULT_PERIOD_S = 0.1  # for recordings without stamps: 10 Hz as most LiDARs
INT16_MAX = 32767
SINGLES = (np.int8, np.uint8, np.int16, np.uint16, np.float16, np.float32)  # fit into float32


class Scans(Protocol):
    """Points (n, 3) of each scan [m, sensor frame], possibly read on demand."""

    def __getitem__(self, index: int) -> Points:
        """Return the points of a scan, including non-finite ones."""
        ...


@dataclass(frozen=True)
class StoredScans:
    """Concatenated scans in one array, in units of `scale_m`."""

    points: npt.NDArray[Any]
    scale_m: float
    offsets: npt.NDArray[np.int64]

    def __getitem__(self, index: int) -> Points:
        """Return the points of a scan."""
        part = self.points[self.offsets[index] : self.offsets[index + 1], :3]
        number = np.float32 if part.dtype in SINGLES else np.float64
        metres: Points = part.astype(number) * number(self.scale_m)
        return metres


class PointTimes(Protocol):
    """Times (n) of the points of each scan, in seconds after its stamp."""

    def __getitem__(self, index: int) -> Matrix | None:
        """Return the times of a scan's points, including non-finite points; None if unknown."""
        ...


@dataclass(frozen=True)
class StoredTimes:
    """Times of all points, laid out like StoredScans."""

    times_s: Matrix
    offsets: npt.NDArray[np.int64]

    def __getitem__(self, index: int) -> Matrix:
        """Return the times of a scan's points."""
        return self.times_s[self.offsets[index] : self.offsets[index + 1]].astype(np.float64)


@dataclass(frozen=True)
class Recording:
    """Scans of a drive; `poses` T_map_sensor (S, 4, 4), `stamps` (S) in seconds, or empty."""

    scans: Scans
    poses: Matrix
    stamps: Matrix
    note: str = ""
    point_times: PointTimes | None = None

    def __len__(self) -> int:
        return len(self.poses)

    def scan(self, index: int) -> Points:
        """Return the finite points (n, 3) of a scan in metres, in the sensor frame."""
        points = self.scans[index]
        finite = np.isfinite(points).all(axis=1)
        return points if finite.all() else points[finite]

    def point_times_s(self, index: int) -> Matrix | None:
        """Return the times (n) of the points of scan(), after its stamp; None if unknown."""
        times_s = None if self.point_times is None else self.point_times[index]
        return None if times_s is None else times_s[np.isfinite(self.scans[index]).all(axis=1)]

    def stamp_s(self, index: int) -> float:
        """Return the stamp of a scan; without stamps, the time after the first scan."""
        return float(self.stamps[index] if len(self.stamps) else self.times_s()[index])

    def times_s(self) -> Matrix:
        """Return the times (S) of the scans after the first, also without stamps."""
        if len(self.stamps) == 0:
            return np.arange(len(self), dtype=np.float64) * DEFAULT_PERIOD_S
        times: Matrix = self.stamps - self.stamps[0]
        return times

    def accumulated(self, indices: Sequence[int]) -> Points:
        """Return the points of several scans, in the map frame."""
        scans = [self._in_map(i) for i in indices]
        return np.concatenate(scans) if scans else np.zeros((0, 3), np.float32)

    def _in_map(self, index: int) -> Points:
        """Return a scan in the map frame; float64 if the map is far from its origin.

        Coarse float32 input is not widened, so that it can be detected.
        """
        points = self.scan(index)
        moved = transform(self.poses[index], points.astype(np.float64))
        is_double = needs_doubles(moved) and not why_coarse(points)
        return moved if is_double else moved.astype(points.dtype, copy=False)

    def first(self, count: int | None) -> Recording:
        """Return only the first `count` scans; None for all."""
        return replace(self, poses=self.poses[:count], stamps=self.stamps[:count])


def save_recording(path: Path, drive: Recording, scale_m: float = DEFAULT_SCALE_M) -> None:
    """Write a recording as npz, with points rounded to `scale_m`."""
    scans = [drive.scan(index) for index in range(len(drive))]
    stored = stored_scans(scans, scale_m)
    times = [drive.point_times_s(index) for index in range(len(drive))]
    more: dict[str, Any] = {}
    if any(one is not None for one in times):
        pairs = zip(scans, times, strict=True)  # without times, as if all were at the stamp
        known = [np.zeros(len(scan)) if one is None else one for scan, one in pairs]
        more["times"] = np.concatenate(known).astype(np.float32)
    np.savez_compressed(
        path,
        points=stored.points,
        scale_m=stored.scale_m,
        offsets=stored.offsets,
        poses=drive.poses,
        stamps=drive.stamps,
        note=drive.note,
        **more,
    )


def stored_scans(scans: Sequence[Points], scale_m: float) -> StoredScans:
    """Return scans in metres as integers in units of `scale_m`."""
    offsets = np.cumsum([0, *(len(scan) for scan in scans)], dtype=np.int64)
    steps = np.rint(np.concatenate(scans) / scale_m)
    if steps.size and np.abs(steps).max() > INT16_MAX:
        raise ValueError(f"points beyond {INT16_MAX * scale_m:.0f} m need a larger scale_m")
    return StoredScans(steps.astype(np.int16), scale_m, offsets)


def load_recording(path: Path) -> Recording:
    """Read a recording; raise ManycoreError with the problem if it is invalid."""
    return recording_of(path, load_arrays(path))


def load_arrays(path: Path) -> dict[str, npt.NDArray[Any]]:
    """Return the arrays of an npz file by name; raise ManycoreError if it cannot be read."""
    try:
        with path.open("rb") as raw, np.load(raw, allow_pickle=False) as file:
            # Entries that are no arrays are loaded as bytes.
            return {name: np.asarray(file[name]) for name in file.files}
    except UNREADABLE as error:
        raise _bad(path, f"cannot be read as npz: {why_no_arrays(error)}") from error


def recording_of(path: Path, arrays: Mapping[str, npt.NDArray[Any]]) -> Recording:
    """Return the recording in the arrays of a file; raise ManycoreError if they hold none."""
    missing = RECORDING_ARRAYS - arrays.keys()
    if missing:
        raise _bad(path, f"has no array {', '.join(sorted(missing))}")
    points, poses = arrays["points"], arrays["poses"]
    if problem := _problem(arrays):
        raise _bad(path, problem)
    try:
        stamps = in_seconds(arrays.get("stamps", np.zeros(0)))
        if (np.diff(stamps) <= 0).any():
            raise ValueError("stamps do not increase")
        return Recording(
            StoredScans(points, float(arrays.get("scale_m", 1.0)), arrays["offsets"]),
            rigid(poses),
            stamps,
            str(arrays.get("note", "")),
            StoredTimes(arrays["times"], arrays["offsets"]) if "times" in arrays else None,
        )
    except UNREADABLE as error:
        raise _bad(path, why_unreadable(error)) from error


def _problem(arrays: Mapping[str, npt.NDArray[Any]]) -> str | None:
    """Return the first problem with the shapes of the arrays; None if there is none."""
    points, poses, offsets = arrays["points"], arrays["poses"], arrays["offsets"]
    stamps, scale = arrays.get("stamps", np.zeros(0)), arrays.get("scale_m")
    count = len(poses) if poses.ndim else 0
    has_columns = points.ndim == 2 and points.shape[1] >= 3
    is_scale = scale is None or (scale.ndim == 0 and scale.dtype.kind in "iuf" and 0 < scale < 1e3)
    checks = [
        (points.dtype.kind in "iuf" and has_columns, "points are not (N, 3) numbers"),
        (is_scale, "scale_m is not a positive number"),
        (count > 0 and poses.shape[1:] in ((4, 4), (3, 4)), "poses are not (S, 4, 4) with S > 0"),
        (offsets.shape == (count + 1,), "offsets are not one more than poses"),
        (offsets.dtype.kind in "iu", "offsets are not whole numbers"),
        (stamps.shape in ((0,), (count,)), "stamps are neither empty nor one per pose"),
        (_is_per_point(arrays.get("times"), points), "times are not one number per point"),
    ]
    for good, problem in checks:
        if not good:
            return problem
    if (np.diff(offsets.astype(np.int64)) < 0).any() or not 0 <= offsets[0] <= offsets[-1] <= len(
        points
    ):
        return "offsets do not increase within points"
    return None


def _is_per_point(times: npt.NDArray[Any] | None, points: npt.NDArray[Any]) -> bool:
    return times is None or (times.shape == points.shape[:1] and times.dtype.kind == "f")


def _bad(path: Path, problem: str) -> ManycoreError:
    return ManycoreError(f"{path}: no recording: {problem}", EXIT_BAD_INPUT)
