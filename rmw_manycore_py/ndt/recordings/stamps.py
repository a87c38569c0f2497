# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""Times of scans, in the unit used by a recording."""

from __future__ import annotations

import re
from bisect import bisect_left
from pathlib import Path
from typing import Any

import numpy as np
import numpy.typing as npt

from rmw_manycore_py.ndt.geometry.arrays import Matrix

# (minimum time since 1970, seconds per unit) for nanoseconds, microseconds, milliseconds and
# seconds.
EPOCHS = ((1e17, 1e-9), (1e14, 1e-6), (1e11, 1e-3), (1e8, 1.0))
PERIODS = ((1e7, 1e-9), (1e4, 1e-6), (10.0, 1e-3), (0.0, 1.0))
MAX_NAMED = 3
MIN_DIGITS = 10  # of a file name that is a time since 1970


def in_seconds(stamps: npt.NDArray[Any]) -> Matrix:
    """Return times (S) in seconds; the unit is inferred from magnitude or spacing.

    Times since 1970 reveal their unit; otherwise the median step does: up to 10 means seconds, up
    to 10,000 milliseconds and so on.

    :raises ValueError: if they are not finite.
    """
    if len(stamps) == 0:
        return np.zeros(0)
    if stamps.dtype.kind == "M":
        stamps = stamps.astype("datetime64[ns]").astype(np.int64)
    if stamps.dtype.kind not in "iuf" or not np.isfinite(stamps).all():
        raise ValueError("a stamp is not a finite number")
    if stamps.dtype.kind in "iu":
        stamps = stamps.astype(np.int64)  # differences of unsigned integers cannot be negative
    # The lowest and the median tolerate single wrong stamps.
    period = float(np.median(np.diff(stamps))) if len(stamps) > 1 else 0.0
    unit_s = _unit_s(float(stamps.min()), max(period, 0.0))
    # Subtract the first before converting, so that nanoseconds since 1970 keep their last digits.
    times: Matrix = float(stamps[0]) * unit_s + (stamps - stamps[0]).astype(np.float64) * unit_s
    return times


def in_order(stamps: Matrix) -> npt.NDArray[np.int64]:
    """Return the indices of the longest sequence of increasing stamps."""
    lasts: list[int] = []  # for each length, the last index of the sequence with the lowest end
    before = np.full(len(stamps), -1)
    for index, stamp in enumerate(stamps):
        at = bisect_left(lasts, stamp, key=stamps.__getitem__)
        if at < len(lasts) and stamps[lasts[at]] == stamp:
            continue  # the first of equal ones stays
        before[index] = lasts[at - 1] if at else -1
        lasts[at : at + 1] = [index]
    kept = lasts[-1:]
    while kept and before[kept[-1]] >= 0:
        kept.append(int(before[kept[-1]]))
    return np.array(kept[::-1], np.int64)


def why_left_out(what: str, stamps: Matrix, kept: npt.NDArray[np.int64]) -> str:
    """Return a remark that names the stamps not kept; "" if all are."""
    lost = np.setdiff1d(np.arange(len(stamps)), kept)
    if not len(lost):
        return ""
    named = ", ".join(f"{index} ({stamps[index]:.3f} s)" for index in lost[:MAX_NAMED])
    more = f" and {len(lost) - MAX_NAMED} more" if len(lost) > MAX_NAMED else ""
    return f"left out as their times do not increase: {what} {named}{more}"


def _unit_s(lowest: float, period: float) -> float:
    for min_time, unit_s in EPOCHS:
        if lowest >= min_time:
            return unit_s
    return next(unit_s for min_period, unit_s in PERIODS if period >= min_period)


def of_names(paths: list[Path]) -> Matrix:
    """Return the times given by file names; empty if the names are no times."""
    names = [re.sub(r"(\.pcd)?\.[^.]*$", "", path.name, flags=re.IGNORECASE) for path in paths]
    try:
        numbers = np.array([float(name.replace("_", ".", 1)) for name in names])
    except ValueError:
        return np.zeros(0)
    is_time = all(len(name.split(".")[0].split("_")[0]) >= MIN_DIGITS for name in names)
    return in_seconds(numbers) if is_time and (numbers >= EPOCHS[-1][0]).all() else np.zeros(0)


def read_stamps(path: Path) -> Matrix:
    """Read one time per line: numbers, or dates as in KITTI's raw recordings."""
    lines = [line.strip() for line in path.read_text().splitlines() if line.strip()]
    return in_seconds(np.array([_time_of(path, line) for line in lines]))


def _time_of(path: Path, line: str) -> float | np.datetime64:
    try:
        is_date = "-" in line and ":" in line
        return np.datetime64(line.replace(" ", "T"), "ns") if is_date else float(line.split()[0])
    except ValueError:
        raise ValueError(f"{path}: expected one time per line, found '{line[:40]}'") from None
