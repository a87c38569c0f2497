# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""Shape of a course: straight, left turn, straight, right turn, straight."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass

import numpy as np

from rmw_manycore_py.papers.roslite2.laws.trajectory import Trajectory, Vector

SPACING_M = 0.2
ACCELERATION_M_S2 = 0.25  # of the target speed, around turns and at the end
LAST_SPEED_M_S = 0.3  # at the second last point, from which the vehicle rolls to the end


@dataclass(frozen=True)
class CourseShape:
    """Lengths in metres, speeds in m/s; a turn is a quarter circle."""

    length_m: float = 150.0
    turn_radius_m: float = 15.0
    speed_m_s: float = 1.5
    turn_speed_m_s: float = 1.0

    @property
    def turn_m(self) -> float:
        """Length of one turn."""
        return 0.5 * np.pi * self.turn_radius_m

    @property
    def straight_m(self) -> float:
        """Length of each of the three straights."""
        return (self.length_m - 2.0 * self.turn_m) / 3.0

    def corners(self) -> tuple[tuple[float, float], ...]:
        """Return where the straights would intersect, and both ends."""
        side = self.straight_m + self.turn_radius_m
        middle = self.straight_m + 2.0 * self.turn_radius_m
        return (0.0, 0.0), (side, 0.0), (side, middle), (2.0 * side, middle)

    def trajectory(self) -> Trajectory:
        """Return the trajectory from the origin, starting along x."""
        along = np.linspace(0.0, self.length_m, max(3, int(self.length_m / SPACING_M) + 1))
        middle = 0.5 * (along[1:] + along[:-1])
        steps = np.diff(along)
        heading = self._heading(middle)
        # A chord is shorter than its arc.
        chord = steps * np.sinc(steps * self._curvature(middle) / (2.0 * np.pi))
        x = np.concatenate([[0.0], np.cumsum(chord * np.cos(heading))])
        y = np.concatenate([[0.0], np.cumsum(chord * np.sin(heading))])
        return Trajectory(x, y, self._heading(along), self._speeds(along))

    def _turns(self) -> Iterator[tuple[float, float]]:
        """Yield the start of each turn, and its curvature."""
        yield self.straight_m, 1.0 / self.turn_radius_m
        yield 2.0 * self.straight_m + self.turn_m, -1.0 / self.turn_radius_m

    def _curvature(self, along: Vector) -> Vector:
        return sum(
            (
                np.where((along > start) & (along < start + self.turn_m), curvature, 0.0)
                for start, curvature in self._turns()
            ),
            np.zeros_like(along),
        )

    def _heading(self, along: Vector) -> Vector:
        return sum(
            (np.clip(along - start, 0.0, self.turn_m) * k for start, k in self._turns()),
            np.zeros_like(along),
        )

    def _speeds(self, along: Vector) -> Vector:
        """Return speeds limited by the acceleration, and 0 at the end."""
        limits = [(self.length_m - along, LAST_SPEED_M_S)]
        for start, _ in self._turns():
            away = np.maximum(np.maximum(start - along, along - start - self.turn_m), 0.0)
            limits.append((away, self.turn_speed_m_s))
        speeds = np.full_like(along, self.speed_m_s)
        for away, speed in limits:
            np.minimum(speeds, np.sqrt(speed**2 + 2.0 * ACCELERATION_M_S2 * away), out=speeds)
        speeds[-1] = 0.0
        return speeds
