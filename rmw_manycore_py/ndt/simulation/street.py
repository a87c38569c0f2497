# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""A synthetic street along x: ground, houses, parked cars, poles and trees."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from rmw_manycore_py.ndt.geometry.arrays import Matrix

Corners = tuple[float, float, float, float, float, float]  # x, y, z of two corners
KERB_M = 4.5  # from the centre of the road; houses are behind the pavement


@dataclass(frozen=True)
class Street:
    """Metres in the map frame: boxes by two corners (B, 3), upright cylinders, ground at z = 0."""

    lower: Matrix
    upper: Matrix
    centres: Matrix  # (C, 2)
    radii: Matrix  # (C,)
    heights: Matrix  # (C,)


def build_street(length_m: float, generator: np.random.Generator) -> Street:
    """Return a random street from x = -40 m to 40 m beyond its length."""
    start, end = -40.0, length_m + 40.0
    boxes: list[Corners] = []
    for side in (-1.0, 1.0):
        boxes += _houses(start, end, side, generator)
        boxes += _cars(start, end, side, generator)
    corners = np.array(boxes).reshape(-1, 2, 3)
    centres, radii, heights = _uprights(start, end, generator)
    return Street(corners.min(axis=1), corners.max(axis=1), centres, radii, heights)


def _houses(start: float, end: float, side: float, generator: np.random.Generator) -> list[Corners]:
    """Return houses of random width, height and setback, each with a protruding entrance."""
    boxes = []
    x = start
    while x < end:
        width, height = generator.uniform(8.0, 20.0), generator.uniform(4.0, 14.0)
        front = side * (KERB_M + generator.uniform(2.0, 5.0))
        boxes.append((x, front, 0.0, x + width, front + side * 10.0, height))
        door = x + generator.uniform(0.2, 0.7) * width
        boxes.append((door, front - side * 1.2, 0.0, door + 1.8, front, 2.8))
        x += width + generator.uniform(1.5, 6.0)
    return boxes


def _cars(start: float, end: float, side: float, generator: np.random.Generator) -> list[Corners]:
    """Return parked cars, each with a body and a cabin."""
    boxes = []
    x = start + generator.uniform(0.0, 10.0)
    while x < end:
        inner, outer = side * (KERB_M - 2.2), side * (KERB_M - 0.4)
        boxes.append((x, inner, 0.2, x + 4.3, outer, 0.9))
        boxes.append((x + 1.0, inner, 0.9, x + 3.3, outer, 1.5))
        x += generator.uniform(6.0, 18.0)
    return boxes


def _uprights(
    start: float, end: float, generator: np.random.Generator
) -> tuple[Matrix, Matrix, Matrix]:
    """Return centres, radii and heights of poles and trees on both pavements."""
    count = int((end - start) / 7.0)
    x = generator.uniform(start, end, count)
    y = generator.choice([-1.0, 1.0], count) * (KERB_M + generator.uniform(0.3, 1.2, count))
    is_tree = generator.random(count) < 0.5
    radii = np.where(is_tree, generator.uniform(0.2, 0.4, count), 0.08)
    heights = np.where(is_tree, generator.uniform(3.0, 7.0, count), 6.0)
    return np.stack([x, y], axis=1), radii, heights
