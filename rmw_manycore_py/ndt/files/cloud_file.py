# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""Reads and writes point cloud files: PCD and PLY, by the suffix of their names."""

from __future__ import annotations

from pathlib import Path
from types import ModuleType

from rmw_manycore_py.errors import EXIT_BAD_INPUT, ManycoreError, shorten
from rmw_manycore_py.errors.missing_library import OPEN3D, require
from rmw_manycore_py.ndt.files.pcd_file import read_pcd
from rmw_manycore_py.ndt.files.ply_file import read_ply
from rmw_manycore_py.ndt.files.unreadable import UNREADABLE, why_unreadable
from rmw_manycore_py.ndt.geometry.arrays import Points
from rmw_manycore_py.ndt.geometry.precision import narrowed


def read_cloud(path: Path) -> Points:
    """Return the points (N, 3) of a PCD or PLY file, including non-finite ones."""
    read = read_pcd if suffix_of(path) == ".pcd" else read_ply
    try:
        return narrowed(read(path))
    except UNREADABLE as error:
        raise map_error(path, why_unreadable(error)) from error


def suffix_of(path: Path) -> str:
    """Return the suffix of a name in lower case: other systems write `MAP.PCD`."""
    return path.suffix.lower()


def load_open3d() -> ModuleType:
    """Return the module Open3D; raise ManycoreError with install instructions if missing."""
    open3d = require(OPEN3D)
    open3d.utility.set_verbosity_level(open3d.utility.VerbosityLevel.Error)
    return open3d


def map_error(path: Path, problem: str) -> ManycoreError:
    """Return the error for a map that cannot be read or written."""
    return ManycoreError(f"map {path}: {shorten(problem)}", EXIT_BAD_INPUT)
