# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""Assigns poses to scans."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path

import numpy as np
import numpy.typing as npt

from rmw_manycore_py.errors import EXIT_BAD_INPUT, ManycoreError
from rmw_manycore_py.ndt.geometry.arrays import Matrix, Points
from rmw_manycore_py.ndt.recordings.pose_file import PoseLine
from rmw_manycore_py.ndt.recordings.recording import PointTimes, Recording, Scans


@dataclass(frozen=True)
class SomeTimes:
    """Point times of a subset of scans."""

    times: PointTimes
    indices: npt.NDArray[np.int64]

    def __getitem__(self, index: int) -> Matrix:
        """Return the times of a scan's points."""
        return self.times[int(self.indices[index])]


@dataclass(frozen=True)
class SomeScans:
    """A subset of scans, by index."""

    scans: Scans
    indices: npt.NDArray[np.int64]

    def __getitem__(self, index: int) -> Points:
        """Return the points of a scan."""
        return self.scans[int(self.indices[index])]


def recorded(
    path: Path,
    scans: Scans,
    count: int,
    stamps_s: Matrix,
    poses: PoseLine,
    note: str = "",
    point_times: PointTimes | None = None,
) -> Recording:
    """Return a recording of `count` scans, with poses interpolated at their stamps or one per scan.

    Scans outside the poses or in a gap between them are dropped; the recording's note says how
    many.

    :raises ManycoreError: if there are neither stamps on both sides nor equally many.
    """
    if len(stamps_s) not in (0, count):
        raise ManycoreError(f"{path}: {count} scans, but {len(stamps_s)} times", EXIT_BAD_INPUT)
    if np.any(np.diff(stamps_s) <= 0):
        raise ManycoreError(f"{path}: the times of the scans do not increase", EXIT_BAD_INPUT)
    if len(poses.poses) == count:
        stamps = stamps_s if len(stamps_s) else poses.stamps
        if not len(stamps_s) or not len(poses.stamps):
            return Recording(scans, poses.poses, stamps, _note(path, note), point_times)
    if len(stamps_s) and len(poses.stamps):
        known, T = poses.at(stamps_s)
        if len(known):
            left_out = count - len(known)
            lost = f"{left_out} of {count} scans have no pose" if left_out else ""
            some = None if point_times is None else SomeTimes(point_times, known)
            said = _note(path, note, lost)
            return Recording(SomeScans(scans, known), T, stamps_s[known], said, some)
        found = f"scans from {stamps_s[0]:.3f} to {stamps_s[-1]:.3f} s, poses from "
        found += f"{poses.stamps[0]:.3f} to {poses.stamps[-1]:.3f} s"
        raise ManycoreError(f"{path}: no scan has a pose near its time: {found}", EXIT_BAD_INPUT)
    raise ManycoreError(
        f"{path}: {count} scans, but {len(poses.poses)} poses: expected one for each, or times of "
        "both (scans: times.txt or names; poses: TUM)",
        EXIT_BAD_INPUT,
    )


def _note(path: Path, *remarks: str) -> str:
    """Return the path with remarks."""
    said = "; ".join(remark for remark in remarks if remark)
    return f"{path}: {said}" if said else str(path)
