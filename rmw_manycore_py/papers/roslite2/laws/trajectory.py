# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""A trajectory, and checks whether it can be driven."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property

import numpy as np
import numpy.typing as npt

from rmw_manycore_py.papers.roslite2.laws.following import (
    MAX_STEERING_RAD,
    PlanarPose,
    lateral_deviation_m,
)

Vector = npt.NDArray[np.float64]

MAX_GAP_M = 2.0  # maximum distance between points for following the nearest
MIN_GAP_M = 1e-3
MAX_HEADING_ERROR_RAD = 0.5  # maximum angle between a point's yaw and the direction to the next


@dataclass(frozen=True)
class Trajectory:
    """Points (N,) in the map frame with headings and speeds (m/s)."""

    x_m: Vector
    y_m: Vector
    yaw_rad: Vector
    speed_m_s: Vector

    def __len__(self) -> int:
        return len(self.x_m)

    @cached_property
    def _positions(self) -> Vector:
        return np.column_stack([self.x_m, self.y_m])

    def nearest(self, x_m: float, y_m: float) -> int:
        """Return the index of the point nearest to a position."""
        offsets = self._positions - (x_m, y_m)
        return int(np.argmin(np.einsum("ij,ij->i", offsets, offsets)))

    def pose(self, index: int) -> PlanarPose:
        """Return the pose of a point."""
        place = (self.x_m[index], self.y_m[index], self.yaw_rad[index])
        return PlanarPose(*map(float, place))

    def speed(self, index: int) -> float:
        """Return the target speed at a point in m/s."""
        return float(self.speed_m_s[index])

    def distance_m(self, x_m: float, y_m: float) -> float:
        """Return the distance of a position from the nearest point."""
        nearest = self._positions[self.nearest(x_m, y_m)]
        return float(np.hypot(*(nearest - (x_m, y_m))))

    def lateral_error_m(self, x_m: float, y_m: float) -> float:
        """Return the lateral offset of a position from the trajectory, positive to the left."""
        return lateral_deviation_m(self.pose(self.nearest(x_m, y_m)), x_m, y_m)

    def along_m(self) -> Vector:
        """Return the distance (N,) from the first point to each, along the trajectory."""
        return np.concatenate([[0.0], np.cumsum(self._gaps_m())])

    def _gaps_m(self) -> Vector:
        gaps: Vector = np.hypot(np.diff(self.x_m), np.diff(self.y_m))
        return gaps

    def problem(self, wheel_base_m: float, max_speed_m_s: float) -> tuple[int, str, str] | None:
        """Return why the trajectory cannot be driven: point index, expected, found; None if it can.

        The minimum turning radius follows from the maximum steering angle and the wheel base.
        """
        if len(self) < 2:
            return 0, "two points or more", str(len(self))
        columns = np.column_stack([self._positions, self.yaw_rad, self.speed_m_s])
        return (
            _first(np.any(~np.isfinite(columns), axis=1), "finite numbers", columns)
            or self._speed_problem(max_speed_m_s)
            or self._gap_problem()
            or self._turn_problem(np.tan(MAX_STEERING_RAD) / wheel_base_m)
        )

    def _speed_problem(self, max_speed_m_s: float) -> tuple[int, str, str] | None:
        is_wrong = (self.speed_m_s < 0.0) | (self.speed_m_s > max_speed_m_s)
        if problem := _first(is_wrong, f"a speed from 0 to {max_speed_m_s:g} m/s", self.speed_m_s):
            return problem
        if self.speed_m_s[0] <= 0.0:
            return 0, "a speed above 0 at the first point: else the vehicle never starts", "0"
        return None

    def _gap_problem(self) -> tuple[int, str, str] | None:
        gaps_m = self._gaps_m()
        is_wrong = (gaps_m > MAX_GAP_M) | (gaps_m < MIN_GAP_M)
        expected = f"the next point between {MIN_GAP_M:g} and {MAX_GAP_M:g} m away"
        return _first(is_wrong, expected, gaps_m)

    def _turn_problem(self, max_curvature_1_m: float) -> tuple[int, str, str] | None:
        way = np.arctan2(np.diff(self.y_m), np.diff(self.x_m))
        is_wrong = np.abs(_wrapped(self.yaw_rad[:-1] - way)) > MAX_HEADING_ERROR_RAD
        expected = "a yaw that points to the next point"
        if problem := _first(is_wrong, expected, self.yaw_rad[:-1]):
            return problem
        curvature = np.abs(_wrapped(np.diff(self.yaw_rad))) / self._gaps_m()
        expected = f"a turn of a radius of at least {1.0 / max_curvature_1_m:.2f} m"
        with np.errstate(divide="ignore"):
            return _first(curvature > max_curvature_1_m, expected, 1.0 / curvature)


def _first(
    is_wrong: npt.NDArray[np.bool_], expected: str, values: Vector
) -> tuple[int, str, str] | None:
    """Return the first invalid point with its value; None if all are valid."""
    found = np.flatnonzero(is_wrong)
    if len(found) == 0:
        return None
    index = int(found[0])
    return index, expected, " ".join(f"{value:g}" for value in np.atleast_1d(values[index]))


def _wrapped(angle_rad: Vector) -> Vector:
    wrapped: Vector = (angle_rad + np.pi) % (2.0 * np.pi) - np.pi
    return wrapped
