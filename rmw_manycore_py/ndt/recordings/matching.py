# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""Assigns poses to scans."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path

import numpy as np
import numpy.typing as npt

from rmw_manycore_py.errors import EXIT_BAD_INPUT, ManycoreError
from rmw_manycore_py.ndt.geometry.arrays import Matrix, Points
from rmw_manycore_py.ndt.recordings.pose_file import PoseLine
from rmw_manycore_py.ndt.recordings.recording import PointTimes, Recording, Scans
from rmw_manycore_py.ndt.recordings.stamps import in_order, why_left_out


@dataclass(frozen=True)
class SomeTimes:
    """Point times of a subset of scans."""

    times: PointTimes
    indices: npt.NDArray[np.int64]

    def __getitem__(self, index: int) -> Matrix | None:
        """Return the times of a scan's points; None if unknown."""
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
    remarks: Sequence[str] = (),
    point_times: PointTimes | None = None,
) -> Recording:
    """Return a recording of `count` scans, with poses interpolated at their stamps or one per scan.

    Leaves out scans whose stamps do not increase, and those outside the poses or in a gap between
    them; the recording's note names or counts them.

    :raises ManycoreError: if scans or poses have no stamps, and their numbers differ.
    """
    if len(stamps_s) not in (0, count):
        raise ManycoreError(f"{path}: {count} scans, but {len(stamps_s)} times", EXIT_BAD_INPUT)
    have_stamps = bool(len(stamps_s) and len(poses.stamps))
    if not have_stamps and len(poses.poses) != count:
        raise ManycoreError(
            f"{path}: {count} scans, but {len(poses.poses)} poses: expected one for each, or times "
            "of both (scans: times.txt or names; poses: TUM)",
            EXIT_BAD_INPUT,
        )
    stamps = stamps_s if len(stamps_s) else poses.stamps
    known = in_order(stamps) if len(stamps) else np.arange(count)
    remarks = [*remarks, why_left_out("scans", stamps, known)]
    if have_stamps:
        ordered = in_order(poses.stamps)
        remarks.append(why_left_out("poses", poses.stamps, ordered))
        between, T = poses.chosen(ordered).at(stamps[known])
        if not len(between):
            raise ManycoreError(_no_pose(path, stamps, poses.stamps), EXIT_BAD_INPUT)
        lost = len(known) - len(between)
        remarks.append(f"{lost} of {count} scans have no pose" if lost else "")
        known = known[between]
    else:
        T = poses.poses[known]
    times = None if point_times is None else SomeTimes(point_times, known)
    stamps = stamps[known] if len(stamps) else stamps
    note = "; ".join(remark for remark in remarks if remark)
    note = f"{path}: {note}" if note else str(path)
    return Recording(SomeScans(scans, known), T, stamps, note, times)


def _no_pose(path: Path, scans_s: Matrix, poses_s: Matrix) -> str:
    found = f"scans from {scans_s[0]:.3f} to {scans_s[-1]:.3f} s, poses from "
    found += f"{poses_s[0]:.3f} to {poses_s[-1]:.3f} s" if len(poses_s) else "none"
    return f"{path}: no scan has a pose near its time: {found}"
