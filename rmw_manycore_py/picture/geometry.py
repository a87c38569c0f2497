# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""Rectangles and curves, in viewBox units."""

from __future__ import annotations

import math
from collections.abc import Iterable
from dataclasses import dataclass

Point = tuple[float, float]
_BEND = 0.16  # offset from the straight line, relative to a curve's length


@dataclass(frozen=True)
class Rect:
    """A rectangle, given by its upper left corner."""

    x: float
    y: float
    width: float
    height: float

    @property
    def centre(self) -> Point:
        """Centre."""
        return self.x + self.width / 2, self.y + self.height / 2

    def edge_towards(self, target: Point) -> Point:
        """Return where the line from the centre to an outside point crosses the edge."""
        (x, y), (target_x, target_y) = self.centre, target
        dx, dy = target_x - x, target_y - y
        reach = max(abs(dx) / (self.width / 2), abs(dy) / (self.height / 2))
        return (x, y) if reach == 0 else (x + dx / reach, y + dy / reach)


@dataclass(frozen=True)
class Curve:
    """A quadratic Bezier curve."""

    start: Point
    control: Point
    end: Point

    @property
    def middle(self) -> Point:
        """Point at half the parameter."""
        (x0, y0), (x1, y1), (x2, y2) = self.start, self.control, self.end
        return (x0 + 2 * x1 + x2) / 4, (y0 + 2 * y1 + y2) / 4

    def numbers(self) -> list[float]:
        """Return the coordinates of its three points."""
        return [
            round(value, 1) for point in (self.start, self.control, self.end) for value in point
        ]


def connect(start: Rect, end: Rect) -> Curve:
    """Return a curve between two rectangles; the reverse curve bends to the other side."""
    control = _bent(start.centre, end.centre)
    return Curve(start.edge_towards(control), control, end.edge_towards(control))


def mean(points: Iterable[Point]) -> Point:
    """Return the centroid."""
    found = list(points)
    return sum(x for x, _ in found) / len(found), sum(y for _, y in found) / len(found)


def _bent(start: Point, end: Point) -> Point:
    dx, dy = end[0] - start[0], end[1] - start[1]
    if math.hypot(dx, dy) == 0:
        return start[0], start[1] - 1
    return (start[0] + end[0]) / 2 - dy * _BEND, (start[1] + end[1]) / 2 + dx * _BEND
