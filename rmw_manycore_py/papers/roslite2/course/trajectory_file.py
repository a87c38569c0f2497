# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""Trajectories in CSV files: `x_m,y_m,yaw_rad,speed_m_s`, one point per line."""

from __future__ import annotations

import csv
from pathlib import Path

import numpy as np

from rmw_manycore_py.errors import EXIT_BAD_INPUT, FileError, ManycoreError, Problem
from rmw_manycore_py.papers.roslite2.laws.trajectory import Trajectory

COLUMNS = ("x_m", "y_m", "yaw_rad", "speed_m_s")
MAX_POINTS = 100_000
HEADER_LINES = 1


def write_trajectory(path: Path, trajectory: Trajectory) -> None:
    """Write a trajectory, rounded to 0.1 mm and 0.1 mrad."""
    columns = (trajectory.x_m, trajectory.y_m, trajectory.yaw_rad, trajectory.speed_m_s)
    rows = np.column_stack(columns)
    np.savetxt(path, rows, "%.4f", ",", header=",".join(COLUMNS), comments="")


def read_trajectory(path: Path, wheel_base_m: float, max_speed_m_s: float) -> Trajectory:
    """Read a trajectory and check that a vehicle can drive it.

    :raises FileError: with file and line, for an invalid or undrivable trajectory.
    """
    trajectory = _parsed(path)
    problem = trajectory.problem(wheel_base_m, max_speed_m_s)
    if problem is not None:
        index, expected, found = problem
        raise FileError(Problem(path, index + 1 + HEADER_LINES, "", expected, found))
    return trajectory


def _parsed(path: Path) -> Trajectory:
    try:
        with path.open(newline="", encoding="utf-8") as file:
            lines = csv.reader(file)
            header = next(lines, [])
            if tuple(name.strip() for name in header) != COLUMNS:
                raise FileError(Problem(path, 1, "", ",".join(COLUMNS), ",".join(header)))
            rows = [_row(path, number, line) for number, line in enumerate(lines, start=2) if line]
    except (OSError, UnicodeDecodeError, csv.Error) as error:
        reason = error.strerror if isinstance(error, OSError) else error
        raise ManycoreError(f"{path}: cannot be read: {reason}", EXIT_BAD_INPUT) from error
    return Trajectory(*np.array(rows, np.float64).reshape(-1, len(COLUMNS)).T)


def _row(path: Path, number: int, line: list[str]) -> list[float]:
    if number > MAX_POINTS + HEADER_LINES:
        raise FileError(Problem(path, number, "", f"at most {MAX_POINTS} points", "more"))
    try:
        values = [float(cell) for cell in line]
    except ValueError:
        values = []
    if len(values) != len(COLUMNS):
        raise FileError(Problem(path, number, "", f"{len(COLUMNS)} numbers", ",".join(line)))
    return values
