# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""Pose files: text with one pose per line, in the formats of common datasets.

| numbers in a line | |
|---|---|
| 12, 16 | rows of T_map_sensor (KITTI), without or with the last row |
| 13, 17 | the same after a time |
| 8 | time, x, y, z, qx, qy, qz, qw (TUM) |
| 7 | the same without a time |

KITTI's own poses are the camera's; `Tr` in a `calib.txt` beside the file gives the LiDAR's.
"""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path

import numpy as np
import numpy.typing as npt

from rmw_manycore_py.errors import EXIT_BAD_INPUT, ManycoreError
from rmw_manycore_py.ndt.files.unreadable import why_unreadable
from rmw_manycore_py.ndt.geometry import poses
from rmw_manycore_py.ndt.geometry.arrays import Matrix
from rmw_manycore_py.ndt.recordings.stamps import in_seconds

FORMATS = "lines of 12 numbers (KITTI) or of time x y z qx qy qz qw (TUM)"
MATRIX_COLUMNS = {12: 0, 16: 0, 13: 1, 17: 1}  # number of columns before the matrix
QUATERNION_COLUMNS = {7: 0, 8: 1}
LONGEST_GAP_S = 1.0  # maximum gap to interpolate over


@dataclass(frozen=True)
class PoseLine:
    """Poses T_map_sensor (S, 4, 4); `stamps` (S) in seconds, or empty."""

    poses: Matrix
    stamps: Matrix

    def chosen(self, indices: npt.NDArray[np.int64]) -> PoseLine:
        """Return only these poses."""
        return PoseLine(
            self.poses[indices], self.stamps[indices] if len(self.stamps) else self.stamps
        )

    def at(self, stamps_s: Matrix) -> tuple[npt.NDArray[np.int64], Matrix]:
        """Return the indices of stamps that lie between poses, and the poses (n, 4, 4) there.

        The stamps of the poses have to increase.
        """
        after = np.searchsorted(self.stamps, stamps_s)
        known, found = [], []
        for index, (stamp_s, new) in enumerate(zip(stamps_s, after, strict=True)):
            if new < len(self.stamps) and self.stamps[new] == stamp_s:
                old = new
            elif 0 < new < len(self.stamps):
                old = new - 1
            else:
                continue
            span_s = float(self.stamps[new] - self.stamps[old])
            if span_s > LONGEST_GAP_S:
                continue
            share = float(stamp_s - self.stamps[old]) / span_s if span_s else 0.0
            known.append(index)
            found.append(poses.interpolate(self.poses[old], self.poses[new], share))
        return np.array(known, np.int64), np.array(found).reshape(-1, 4, 4)


def read_poses(path: Path) -> PoseLine:
    """Read a pose file; raise ManycoreError with the expected formats if it is invalid."""
    try:
        table = _table(path)
        columns = table.shape[1]
        if columns in MATRIX_COLUMNS:
            first = MATRIX_COLUMNS[columns]
            T = poses.rigid(table[:, first : first + 12].reshape(-1, 3, 4))
            T = _of_lidar(T, path.with_name("calib.txt"))
        elif columns in QUATERNION_COLUMNS:
            first = QUATERNION_COLUMNS[columns]
            T = _of_quaternions(table[:, first:])
        else:
            raise ValueError(f"expected {FORMATS}, found {columns} numbers")
        return PoseLine(T, in_seconds(table[:, 0]) if first else np.zeros(0))
    except (OSError, UnicodeDecodeError, ValueError) as error:
        raise ManycoreError(f"poses {path}: {why_unreadable(error)}", EXIT_BAD_INPUT) from error


def _table(path: Path) -> Matrix:
    """Return the numbers; skip comments and a header line."""
    lines = [line.replace(",", " ").split() for line in path.read_text().splitlines()]
    rows = [line for line in lines if line and not line[0].startswith("#")]
    if rows and not _is_number(rows[0][0]):
        rows = rows[1:]
    if not rows:
        raise ValueError(f"expected {FORMATS}, found none")
    for number, row in enumerate(rows):
        if len(row) != len(rows[0]) or not all(_is_number(word) for word in row):
            raise ValueError(f"expected {FORMATS}; pose {number} is '{' '.join(row)[:80]}'")
    return np.array(rows, np.float64)


def _is_number(word: str) -> bool:
    try:
        float(word)
    except ValueError:
        return False
    return True


def _of_quaternions(numbers: Matrix) -> Matrix:
    """Return T (S, 4, 4) for rows of x, y, z, qx, qy, qz, qw."""
    matrices = np.tile(np.eye(4), (len(numbers), 1, 1))
    for T, row in zip(matrices, numbers, strict=True):
        if not np.linalg.norm(row[3:]) > 0.0:
            raise ValueError("a quaternion is zero or not finite")
        T[:3, :3], T[:3, 3] = poses.from_quaternion(row[3:]), row[:3]
    return poses.rigid(matrices)


def _of_lidar(T_map_camera: Matrix, calibration: Path) -> Matrix:
    """Return T_map_lidar (S, 4, 4), with the map frame aligned to the first scan."""
    lines = calibration.read_text().splitlines() if calibration.is_file() else []
    numbers = next((line.split()[1:] for line in lines if line.startswith(("Tr:", "Tr "))), None)
    if numbers is None:
        return T_map_camera
    T_camera_lidar = poses.rigid(np.array(numbers, np.float64).reshape(1, 3, 4))[0]
    T_map_lidar: Matrix = poses.inverse(T_camera_lidar) @ T_map_camera @ T_camera_lidar
    return T_map_lidar
