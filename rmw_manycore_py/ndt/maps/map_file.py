# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""Point-cloud map files: PCD, PLY and npz (`points` alone, or the arrays of a recording).

Points keep the precision of the file: float64 or float32 (precision.py).
"""

from __future__ import annotations

from pathlib import Path
from typing import Any

import numpy as np
import numpy.typing as npt

from rmw_manycore_py.ndt.files.cloud_file import load_open3d, map_error, read_cloud, suffix_of
from rmw_manycore_py.ndt.files.pcd_file import write_pcd
from rmw_manycore_py.ndt.files.ply_file import write_ply
from rmw_manycore_py.ndt.files.unreadable import UNREADABLE, why_unreadable
from rmw_manycore_py.ndt.geometry.arrays import Points
from rmw_manycore_py.ndt.geometry.precision import needs_doubles
from rmw_manycore_py.ndt.recordings.recording import RECORDING_ARRAYS, load_arrays, recording_of

SUFFIXES = (".pcd", ".ply", ".npz")


def read_points(path: Path, leaf_m: float = 0.0) -> Points:
    """Return the finite points (N, 3) of a map; downsampled to voxels of `leaf_m` if non-zero.

    The scans of a recording (npz) are accumulated with their poses.

    :raises ManycoreError: if the file is missing, broken, empty or of another kind.
    """
    if suffix_of(path) not in SUFFIXES:
        raise map_error(path, f"expected a file that ends in {', '.join(SUFFIXES)}")
    if not path.is_file():
        raise map_error(path, "there is no such file")
    points = _read_npz(path) if suffix_of(path) == ".npz" else read_cloud(path)
    points = points[np.isfinite(points).all(axis=1)]
    if len(points) == 0:
        raise map_error(path, "it has no points: it is empty, broken, or not what its name says")
    try:
        return _thinned(points, leaf_m) if leaf_m > 0.0 else points
    except RuntimeError as error:
        small = "such voxels are too small for its extent"
        raise map_error(path, f"it cannot be downsampled to {leaf_m:g} m: {small}") from error


def write_points(path: Path, points: Points) -> None:
    """Write a map of points (N, 3) in the map frame, as float32 if that is precise enough."""
    kept = points if needs_doubles(points) else points.astype(np.float32)
    write = {".npz": _write_npz, ".pcd": write_pcd, ".ply": write_ply}.get(suffix_of(path))
    if write is None:
        raise map_error(path, f"expected a file that ends in {', '.join(SUFFIXES)}")
    write(path, kept)


def _write_npz(path: Path, points: Points) -> None:
    """Write a recording of one scan with the sensor at the map's origin."""
    offsets, poses = _of_one_scan(len(points))
    np.savez_compressed(path, points=points, offsets=offsets, poses=poses, note="map")


def _of_one_scan(points: int) -> tuple[npt.NDArray[Any], npt.NDArray[Any]]:
    """Return offsets and poses of a recording of one scan, in the map frame."""
    return np.array([0, points]), np.eye(4)[None]


def _read_npz(path: Path) -> Points:
    arrays = load_arrays(path)
    found = RECORDING_ARRAYS & arrays.keys()
    if found == {"points"}:
        count = len(np.atleast_1d(arrays["points"]))
        arrays["offsets"], arrays["poses"] = _of_one_scan(count)
    elif found != RECORDING_ARRAYS:
        missing = ", ".join(sorted(RECORDING_ARRAYS - found))
        both = "points (N, 3) [m, map frame] alone, or points, offsets and poses of a recording"
        raise map_error(path, f"it has no array {missing}: expected {both}")
    recording = recording_of(path, arrays)
    try:
        return recording.accumulated(range(len(recording)))
    except UNREADABLE as error:
        raise map_error(path, why_unreadable(error)) from error


def _thinned(points: Points, leaf_m: float) -> Points:
    o3d = load_open3d()
    cloud = o3d.geometry.PointCloud(o3d.utility.Vector3dVector(points.astype(np.float64)))
    return np.asarray(cloud.voxel_down_sample(leaf_m).points).astype(points.dtype)
