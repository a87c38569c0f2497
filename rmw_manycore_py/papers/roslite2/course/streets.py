# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""Three synthetic streets along a course, with the vehicle's path cleared."""

from __future__ import annotations

import shlex
from itertools import pairwise
from pathlib import Path

import numpy as np
import numpy.typing as npt

from rmw_manycore_py.errors import EXIT_BAD_INPUT, ManycoreError, what_is_wrong
from rmw_manycore_py.ndt.files.unreadable import UNREADABLE
from rmw_manycore_py.ndt.geometry.arrays import Matrix
from rmw_manycore_py.ndt.simulation.street import Street, build_street
from rmw_manycore_py.papers.roslite2.course.shape import CourseShape
from rmw_manycore_py.papers.roslite2.laws.trajectory import Trajectory

CLEARANCE_M = 1.5  # minimum distance of obstacles from the trajectory
ARRAYS = ("lower", "upper", "centres", "radii", "heights")


def build_streets(
    shape: CourseShape, trajectory: Trajectory, generator: np.random.Generator
) -> Street:
    """Return the streets of `ndt simulate` along the straights, with the path cleared."""
    parts = [
        _placed(build_street(float(np.hypot(*np.subtract(end, start))), generator), start, end)
        for start, end in pairwise(shape.corners())
    ]
    return _cleared(joined(parts), np.column_stack([trajectory.x_m, trajectory.y_m]))


def joined(streets: list[Street]) -> Street:
    """Merge several streets."""
    columns = [np.concatenate([getattr(one, name) for one in streets]) for name in ARRAYS]
    return Street(*columns)


def near(street: Street, x_m: float, y_m: float, range_m: float) -> Street:
    """Return the part of a street within the range of a sensor."""
    place = np.array([x_m, y_m])
    boxes = _box_distances(street, place) < range_m
    uprights = np.hypot(*(street.centres - place).T) - street.radii < range_m
    return _selected(street, boxes, uprights)


def save_streets(path: Path, street: Street) -> None:
    """Write a street as npz."""
    np.savez_compressed(path, **{name: getattr(street, name) for name in ARRAYS})


def load_streets(path: Path) -> Street:
    """Return a saved street; raise ManycoreError if the file is invalid."""
    try:
        with path.open("rb") as opened, np.load(opened) as file:
            columns = [np.asarray(file[name], np.float64) for name in ARRAYS]
    except UNREADABLE as error:
        raise ManycoreError(
            f"{path}: expected the streets of a course, found: {what_is_wrong(error)}; make the "
            f"course again: `manycore whill course {shlex.quote(str(path.parent))}`",
            EXIT_BAD_INPUT,
        ) from error
    return Street(*columns)


def _placed(street: Street, start: tuple[float, float], end: tuple[float, float]) -> Street:
    """Return a street along x moved to a start and, if it leads along y, turned left."""
    if start[1] == end[1]:
        offset = np.array([*start, 0.0])
        lower, upper, centres = street.lower + offset, street.upper + offset, street.centres
    else:
        first, second = _turned(street.lower), _turned(street.upper)
        offset = np.array([*start, 0.0])
        lower, upper = np.minimum(first, second) + offset, np.maximum(first, second) + offset
        centres = _turned(street.centres)
    return Street(lower, upper, centres + np.array(start), street.radii, street.heights)


def _turned(places: Matrix) -> Matrix:
    turned: Matrix = places.copy()
    turned[:, 0], turned[:, 1] = -places[:, 1], places[:, 0]
    return turned


def _cleared(street: Street, way: Matrix) -> Street:
    """Return a street without objects within the clearance of a path (N, 2)."""
    boxes = np.full(len(street.lower), np.inf)
    uprights = np.full(len(street.centres), np.inf)
    for place in way:
        np.minimum(boxes, _box_distances(street, place), out=boxes)
        distances = np.hypot(*(street.centres - place).T) - street.radii
        np.minimum(uprights, distances, out=uprights)
    return _selected(street, boxes > CLEARANCE_M, uprights > CLEARANCE_M)


def _box_distances(street: Street, place: Matrix) -> Matrix:
    """Return the distances (B,) from a position (2,) to the boxes, in the plane."""
    outside = np.maximum(np.maximum(street.lower[:, :2] - place, place - street.upper[:, :2]), 0.0)
    distances: Matrix = np.hypot(*outside.T)
    return distances


def _selected(
    street: Street, boxes: npt.NDArray[np.bool_], uprights: npt.NDArray[np.bool_]
) -> Street:
    return Street(
        street.lower[boxes],
        street.upper[boxes],
        street.centres[uprights],
        street.radii[uprights],
        street.heights[uprights],
    )
