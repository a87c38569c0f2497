# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""Writes the poses of a replay as files for other tools (evo, KITTI, TUM)."""

from __future__ import annotations

from collections.abc import Iterable
from pathlib import Path

import numpy as np

from rmw_manycore_py.ndt.geometry import poses
from rmw_manycore_py.ndt.geometry.arrays import Matrix
from rmw_manycore_py.ndt.replay.tally import Tally


def reference_path(path: Path) -> Path:
    """Return the path of the reference poses next to those found."""
    return path.with_name(f"{path.stem}-reference{path.suffix}")


def write_tum(tally: Tally, path: Path) -> None:
    """Write `stamp x y z qx qy qz qw` per answered scan, and the whole reference next to it."""
    found = [(row.stamp_s, row.result) for row in tally.rows if row.result is not None]
    _write(path, (_tum_line(stamp_s, T) for stamp_s, T in found))
    known = ((row.stamp_s, row.reference) for row in tally.rows)
    _write(reference_path(path), (_tum_line(stamp_s, T) for stamp_s, T in known))


def write_kitti(tally: Tally, path: Path) -> None:
    """Write the first three rows of T_map_sensor per scan, and the reference next to it.

    The format has no stamps but one line per scan: unanswered scans are lines of `nan`.
    """
    none = np.full((4, 4), np.nan)
    found = (none if row.result is None else row.result for row in tally.rows)
    _write(path, (_line(T[:3].ravel()) for T in found))
    _write(reference_path(path), (_line(row.reference[:3].ravel()) for row in tally.rows))


def _tum_line(stamp_s: float, T: Matrix) -> str:
    return f"{stamp_s:.9f} {_line([*T[:3, 3], *poses.to_quaternion(T[:3, :3])])}"


def _line(numbers: Iterable[float]) -> str:
    # Keeps micrometres in UTM coordinates, which reach thousands of kilometres.
    return " ".join(f"{number:.13g}" for number in numbers)


def _write(path: Path, lines: Iterable[str]) -> None:
    path.write_text("".join(f"{line}\n" for line in lines))
