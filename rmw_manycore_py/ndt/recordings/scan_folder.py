# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""A recording as a directory with one file per scan, and a pose file (pose_file.py).

Scans are `.bin` (float32 x, y, z, intensity as in KITTI; `.pcd.bin` with ring as in nuScenes),
`.npy` (N, 3 or more), `.pcd` or `.ply`, in the order of the numbers in their names. Times come from
`times.txt` or `timestamps.txt`, from names that are times since 1970, or from the poses.
"""

from __future__ import annotations

import re
from dataclasses import dataclass
from pathlib import Path

import numpy as np

from rmw_manycore_py.errors import EXIT_BAD_INPUT, ManycoreError
from rmw_manycore_py.ndt.files.cloud_file import read_cloud, suffix_of
from rmw_manycore_py.ndt.files.unreadable import UNREADABLE, why_no_arrays, why_unreadable
from rmw_manycore_py.ndt.geometry.arrays import Matrix, Points
from rmw_manycore_py.ndt.recordings.matching import recorded
from rmw_manycore_py.ndt.recordings.pose_file import FORMATS, read_poses
from rmw_manycore_py.ndt.recordings.recording import Recording
from rmw_manycore_py.ndt.recordings.stamps import of_names, read_stamps

SUFFIXES = (".bin", ".npy", ".pcd", ".ply")
STAMP_FILES = ("times.txt", "timestamps.txt")
POSE_FILE = re.compile(r"(poses?|gt|ground_?truth|traj|odom).*\.(txt|tum|kitti|csv)", re.IGNORECASE)
DEPTH = 3  # maximum directory depth of the scans


@dataclass(frozen=True)
class ScanFiles:
    """Scan files, read on demand."""

    paths: tuple[Path, ...]

    def __getitem__(self, index: int) -> Points:
        """Read a scan; raise ManycoreError if the file is broken."""
        return read_scan(self.paths[index])


def read_scan(path: Path) -> Points:
    """Return the points (n, 3) of a file."""
    try:
        if suffix_of(path) == ".bin":
            return _floats(path)
        if suffix_of(path) == ".npy":
            return _array(path)
    except UNREADABLE as error:
        raise ManycoreError(f"scan {path}: {why_unreadable(error)}", EXIT_BAD_INPUT) from error
    return read_cloud(path)


def _floats(path: Path) -> Points:
    columns = 5 if path.name.lower().endswith(".pcd.bin") else 4
    size_bytes = path.stat().st_size
    if size_bytes % (4 * columns):
        raise ValueError(f"expected points of {4 * columns} bytes, found {size_bytes} bytes")
    return np.fromfile(path, np.float32).reshape(-1, columns)[:, :3]


def _array(path: Path) -> Points:
    try:
        array = np.load(path, allow_pickle=False)
    except UNREADABLE as error:
        raise ValueError(why_no_arrays(error)) from error
    if array.ndim < 2 or array.shape[-1] < 3 or array.dtype.kind not in "iuf":
        raise ValueError(f"expected points (n, 3 or more), found the shape {array.shape}")
    return np.asarray(array.reshape(-1, array.shape[-1])[:, :3], np.float32)


def open_folder(folder: Path, poses_path: Path | None) -> Recording:
    """Open the recording in a directory or below it."""
    scans = _scans_of(folder)
    places = [scans[0].parent, *scans[0].parent.parents][: DEPTH + 1]
    poses = read_poses(poses_path or _poses_beside(folder, places))
    try:
        stamps = _stamps_of(scans, places)
    except ValueError as error:
        raise ManycoreError(str(error), EXIT_BAD_INPUT) from error
    return recorded(folder, ScanFiles(tuple(scans)), len(scans), stamps, poses)


def _scans_of(folder: Path) -> list[Path]:
    """Return the files of the only directory with scans, in numeric order."""
    found: dict[Path, list[Path]] = {}
    for path in folder.rglob("*"):
        if suffix_of(path) in SUFFIXES and len(path.relative_to(folder).parts) <= DEPTH:
            found.setdefault(path.parent, []).append(path)
    if not found:
        raise ManycoreError(
            f"{folder}: no recording: expected scans as {', '.join(SUFFIXES)}, or a rosbag2 with "
            "its metadata.yaml",
            EXIT_BAD_INPUT,
        )
    if len(found) > 1:
        names = ", ".join(sorted(str(path) for path in found))
        raise ManycoreError(
            f"{folder}: several directories have scans, name one: {names}", EXIT_BAD_INPUT
        )
    return sorted(next(iter(found.values())), key=_as_counted)


def _as_counted(path: Path) -> list[tuple[bool, int, str]]:
    """Return a key that sorts scan_2 before scan_10."""
    words = re.split(r"(\d+)", path.name)
    return [(word.isdigit(), int(word) if word.isdigit() else 0, word) for word in words]


def _poses_beside(folder: Path, places: list[Path]) -> Path:
    """Return the only file near the scans with a name like poses."""
    for place in places:
        found = sorted(path for path in place.iterdir() if POSE_FILE.fullmatch(path.name))
        if len(found) == 1:
            return found[0]
        if found or place == folder:
            break
    names = ", ".join(path.name for path in found) or "none"
    raise ManycoreError(
        f"{folder}: no recording without reference poses: name their file with --poses, {FORMATS} "
        f"(found: {names})",
        EXIT_BAD_INPUT,
    )


def _stamps_of(scans: list[Path], places: list[Path]) -> Matrix:
    for place in places:
        for name in STAMP_FILES:
            if (place / name).is_file():
                return read_stamps(place / name)
    return of_names(scans)
