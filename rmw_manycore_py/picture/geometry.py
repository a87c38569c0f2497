# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""Rectangles and lines, in viewBox units."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from itertools import pairwise

Point = tuple[float, float]
Line = tuple[Point, ...]  # horizontal and vertical pieces in turn
_BEND = 5.0  # radius of corners
_HEAD_LENGTH, _HEAD_HALF = 8.0, 4.0


@dataclass(frozen=True)
class Rect:
    """A rectangle, given by its upper left corner."""

    x: float
    y: float
    width: float
    height: float

    @property
    def right(self) -> float:
        """Right edge."""
        return self.x + self.width

    @property
    def bottom(self) -> float:
        """Lower edge."""
        return self.y + self.height

    @property
    def centre(self) -> Point:
        """Centre."""
        return self.x + self.width / 2, self.y + self.height / 2


def without_repetition(points: Sequence[Point]) -> Line:
    """Return a line without pieces of no length."""
    return tuple(a for a, b in pairwise([*points, (-1.0, -1.0)]) if a != b)


def path_of(line: Line) -> str:
    """Return the SVG path of a line, with rounded corners."""
    parts = ["M{:.1f} {:.1f}".format(*line[0])]
    for before, corner, after in zip(line, line[1:], line[2:], strict=False):
        into, out = _towards(corner, before), _towards(corner, after)
        parts.append("L{:.1f} {:.1f}Q{:.1f} {:.1f} {:.1f} {:.1f}".format(*into, *corner, *out))
    parts.append("L{:.1f} {:.1f}".format(*line[-1]))
    return "".join(parts)


def head_of(line: Line) -> str:
    """Return the SVG path of the arrowhead at the end of a line."""
    (x0, y0), (x, y) = line[-2:]
    length = max(abs(x - x0) + abs(y - y0), 1e-9)
    dx, dy = (x - x0) / length, (y - y0) / length
    back_x, back_y = x - dx * _HEAD_LENGTH, y - dy * _HEAD_LENGTH
    side_x, side_y = dy * _HEAD_HALF, dx * _HEAD_HALF
    return (
        f"M{x:.1f} {y:.1f}L{back_x + side_x:.1f} {back_y + side_y:.1f}"
        f"L{back_x - side_x:.1f} {back_y - side_y:.1f}Z"
    )


def _towards(corner: Point, other: Point) -> Point:
    """Return where the rounding of a corner begins: at most half way to the next one."""
    dx, dy = other[0] - corner[0], other[1] - corner[1]
    length = abs(dx) + abs(dy)
    reach = min(_BEND, length / 2) / length
    return corner[0] + dx * reach, corner[1] + dy * reach
