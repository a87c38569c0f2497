# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""A recorded drive: LiDAR scans with their poses, in one npz file.

| array | shape | meaning |
|---|---|---|
| `points` | int16 (N, 3), or floating point | times `scale_m`: metres in the sensor frame |
| `scale_m` | scalar, 1 where it is missing | |
| `offsets` | integer (S + 1) | scan i is `points[offsets[i]:offsets[i + 1]]` |
| `poses` | float64 (S, 4, 4) | T_map_sensor of each scan |
| `stamps` | float64 (S), or empty | seconds |
| `note` | text | where it came from |
"""

from __future__ import annotations

import zipfile
from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np
import numpy.typing as npt

from rmw_manycore_py.errors import EXIT_BAD_INPUT, ManycoreError
from rmw_manycore_py.ndt.poses import Matrix, transform

DEFAULT_SCALE_M = 0.002
DEFAULT_PERIOD_S = 0.1  # of recordings without stamps: the 10 Hz of most LiDARs
INT16_MAX = 32767


@dataclass(frozen=True)
class Recording:
    """Scans of a drive; `points` as stored, `poses` T_map_sensor (S, 4, 4), `stamps` seconds."""

    points: npt.NDArray[Any]
    scale_m: float
    offsets: npt.NDArray[np.int64]
    poses: Matrix
    stamps: Matrix
    note: str = ""

    def __len__(self) -> int:
        return len(self.poses)

    def scan(self, index: int) -> npt.NDArray[np.float32]:
        """Return the points (n, 3) of a scan in metres, in the sensor frame."""
        part = self.points[self.offsets[index] : self.offsets[index + 1]]
        metres: npt.NDArray[np.float32] = part.astype(np.float32) * np.float32(self.scale_m)
        return metres

    def times_s(self) -> Matrix:
        """Return the time of each scan after the first; even where there are no stamps."""
        if len(self.stamps) == 0:
            return np.arange(len(self), dtype=np.float64) * DEFAULT_PERIOD_S
        times: Matrix = self.stamps - self.stamps[0]
        return times

    def accumulated(self, indices: Sequence[int]) -> npt.NDArray[np.float32]:
        """Return all points of some scans, in the map frame."""
        scans = [transform(self.poses[i], self.scan(i)) for i in indices]
        return np.concatenate(scans) if scans else np.zeros((0, 3), np.float32)

    def first(self, count: int) -> Recording:
        """Return the first scans only."""
        return Recording(
            self.points,
            self.scale_m,
            self.offsets[: count + 1],
            self.poses[:count],
            self.stamps[:count],
            self.note,
        )

    def save(self, path: Path) -> None:
        """Write the file."""
        np.savez_compressed(
            path,
            points=self.points,
            scale_m=self.scale_m,
            offsets=self.offsets,
            poses=self.poses,
            stamps=self.stamps,
            note=self.note,
        )


def recording_of(
    scans: Sequence[npt.NDArray[np.float32]],
    poses: Matrix,
    stamps: Matrix,
    note: str,
    scale_m: float = DEFAULT_SCALE_M,
) -> Recording:
    """Return a recording of scans in metres, rounded to `scale_m`."""
    offsets = np.cumsum([0, *(len(scan) for scan in scans)], dtype=np.int64)
    steps = np.rint(np.concatenate(scans) / scale_m)
    if steps.size and np.abs(steps).max() > INT16_MAX:
        raise ValueError(f"points beyond {INT16_MAX * scale_m:.0f} m need a larger scale_m")
    return Recording(steps.astype(np.int16), scale_m, offsets, poses, stamps, note)


def load_recording(path: Path) -> Recording:
    """Read a recording; a file that is none is an error that says what is wrong with it."""
    try:
        with path.open("rb") as raw, np.load(raw, allow_pickle=False) as file:
            arrays = {name: file[name] for name in file.files}
    except (OSError, ValueError, zipfile.BadZipFile, EOFError) as error:
        raise _bad(path, f"cannot be read as npz: {error}") from error
    missing = {"points", "offsets", "poses"} - arrays.keys()
    if missing:
        raise _bad(path, f"has no array {', '.join(sorted(missing))}")
    recording = Recording(
        points=arrays["points"],
        scale_m=float(arrays.get("scale_m", 1.0)),
        offsets=arrays["offsets"].astype(np.int64),
        poses=arrays["poses"].astype(np.float64),
        stamps=arrays.get("stamps", np.zeros(0)).astype(np.float64),
        note=str(arrays.get("note", "")),
    )
    if problem := _problem(recording):
        raise _bad(path, problem)
    return recording


def _problem(r: Recording) -> str | None:
    """Return the first thing that is wrong."""
    count = len(r.poses)
    checks = [
        (r.points.ndim == 2 and r.points.shape[-1] == 3, "points are not (N, 3)"),
        (r.poses.shape == (count, 4, 4) and count > 0, "poses are not (S, 4, 4) with S > 0"),
        (r.offsets.shape == (count + 1,), "offsets are not one more than poses"),
        (bool(np.isfinite(r.poses).all()), "a pose is not finite"),
        (r.scale_m > 0 and np.isfinite(r.scale_m), "scale_m is not positive"),
        (r.stamps.shape in ((0,), (count,)), "stamps are neither empty nor one per pose"),
        (bool(np.isfinite(r.stamps).all()), "a stamp is not finite"),
        (bool((np.diff(r.stamps) > 0).all()), "stamps do not increase"),
    ]
    for good, problem in checks:
        if not good:
            return problem
    if (np.diff(r.offsets) < 0).any() or r.offsets[0] < 0 or r.offsets[-1] > len(r.points):
        return "offsets do not increase within points"
    return None


def _bad(path: Path, problem: str) -> ManycoreError:
    return ManycoreError(f"{path}: no recording: {problem}", EXIT_BAD_INPUT)
