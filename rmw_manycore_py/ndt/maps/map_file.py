# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""Point-cloud map files: PCD, PLY and npz (the format of recordings).

Points keep the precision of the file: float64 or float32 (precision.py).
"""

from __future__ import annotations

from pathlib import Path

import numpy as np

from rmw_manycore_py.ndt.files.cloud_file import load_open3d, map_error, read_cloud, suffix_of
from rmw_manycore_py.ndt.files.pcd_file import write_pcd
from rmw_manycore_py.ndt.files.ply_file import write_ply
from rmw_manycore_py.ndt.files.unreadable import UNREADABLE, why_unreadable
from rmw_manycore_py.ndt.geometry.arrays import Points
from rmw_manycore_py.ndt.geometry.precision import needs_doubles
from rmw_manycore_py.ndt.recordings.recording import load_recording

SUFFIXES = (".pcd", ".ply", ".npz")


def read_points(path: Path, leaf_m: float = 0.0) -> Points:
    """Return the finite points (N, 3) of a map; downsampled to voxels of `leaf_m` if non-zero.

    An npz file is a recording whose scans are accumulated with their poses.

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
    offsets = np.array([0, len(points)])
    np.savez_compressed(path, points=points, offsets=offsets, poses=np.eye(4)[None], note="map")


def _read_npz(path: Path) -> Points:
    recording = load_recording(path)
    try:
        return recording.accumulated(range(len(recording)))
    except UNREADABLE as error:
        raise map_error(path, why_unreadable(error)) from error


def _thinned(points: Points, leaf_m: float) -> Points:
    o3d = load_open3d()
    cloud = o3d.geometry.PointCloud(o3d.utility.Vector3dVector(points.astype(np.float64)))
    return np.asarray(cloud.voxel_down_sample(leaf_m).points).astype(points.dtype)
