# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""Positions in PCD files (PCL's format, version 0.7), in the precision that the file has.

By pypcd4, not by Open3D: of binary files, one of its readers (0.20) takes doubles for singles, the
other is led astray by the padding fields that PCL writes.
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
MOST_NUMBERS = 10_000  # of a point: pypcd4 names each of them before it looks for any


def read_pcd(path: Path) -> Points:
    """Return the positions (N, 3) of a file, finite or not; raises OSError and ValueError."""
    _check_counts(path)
    from pydantic import ValidationError  # pypcd4 has it; other maps do without

    try:
        cloud = _load_pypcd4().PointCloud.from_path(path)
    except ValidationError as error:
        wrong = ", ".join(f"{entry['loc'][0]}: {entry['msg']}" for entry in error.errors())
        raise ValueError(f"its header is broken: {wrong}") from error
    except (OSError, ValueError):
        raise
    except UNREADABLE as error:
        raise ValueError(f"it is broken: {error!r}") from error  # pypcd4 does not check before
    missing = [axis for axis in AXES if axis not in cloud.fields]
    if missing:
        raise ValueError(f"it has no field {', '.join(missing)}")
    points: Points = np.stack([cloud.pc_data[axis] for axis in AXES], axis=1)
    return points if points.dtype == np.float32 else points.astype(np.float64)


def _check_counts(path: Path) -> None:
    """Raise a ValueError for a header whose points would take all memory by their fields alone."""
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
    """Write positions (N, 3), in the precision that they have, as a binary file."""
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
