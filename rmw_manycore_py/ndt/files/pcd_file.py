# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""Reads and writes positions in PCD files (PCL's format, version 0.7), in the file's precision.

Uses pypcd4 instead of Open3D (0.20): of Open3D's readers of binary files, one reads doubles as
singles, the other fails on the padding fields that PCL writes.
"""

from __future__ import annotations

import re
from pathlib import Path
from types import ModuleType

import numpy as np

from rmw_manycore_py.errors import ManycoreError
from rmw_manycore_py.ndt.files.unreadable import UNREADABLE
from rmw_manycore_py.ndt.geometry.arrays import Points

AXES = ("x", "y", "z")
MOST_NUMBERS = 10_000  # per point: pypcd4 generates a name for each


def read_pcd(path: Path) -> Points:
    """Return the positions (N, 3), including non-finite ones; raises OSError and ValueError."""
    _check_counts(path)
    from pydantic import ValidationError  # a dependency of pypcd4, not of other maps

    try:
        cloud = _load_pypcd4().PointCloud.from_path(path)
    except ValidationError as error:
        wrong = ", ".join(f"{entry['loc'][0]}: {entry['msg']}" for entry in error.errors())
        raise ValueError(f"its header is broken: {wrong}") from error
    except (OSError, ValueError):
        raise
    except UNREADABLE as error:
        raise ValueError(f"it is broken: {error!r}") from error  # pypcd4 does not validate
    missing = [axis for axis in AXES if axis not in cloud.fields]
    if missing:
        raise ValueError(f"it has no field {', '.join(missing)}")
    points: Points = np.stack([cloud.pc_data[axis] for axis in AXES], axis=1)
    return points if points.dtype == np.float32 else points.astype(np.float64)


def _check_counts(path: Path) -> None:
    """Raise ValueError for a header whose fields alone would exhaust memory."""
    with path.open("rb") as file:
        for line in file:
            if line.startswith(b"DATA"):
                return
            numbers = sum(map(int, re.findall(rb"\d+", line))) if line.startswith(b"COUNT") else 0
            if numbers > MOST_NUMBERS:
                raise ValueError(
                    f"each of its points has {numbers} numbers, expected at most {MOST_NUMBERS}"
                )


def write_pcd(path: Path, points: Points) -> None:
    """Write positions (N, 3) in their own precision, as a binary file."""
    _load_pypcd4().PointCloud.from_points(points, AXES, (points.dtype.type,) * 3).save(path)


def _load_pypcd4() -> ModuleType:
    try:
        import pypcd4
    except ImportError as error:
        raise ManycoreError(
            f"pypcd4 cannot be loaded ({error}). Maps as PCD need it: "
            "pip install 'rmw-manycore[ndt]'"
        ) from error
    assert isinstance(pypcd4, ModuleType)
    return pypcd4
