# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""Cars driving ahead of and behind the vehicle: they are not in the map and occlude it."""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np

from rmw_manycore_py.ndt.geometry.arrays import Matrix
from rmw_manycore_py.ndt.simulation.street import Street

LENGTH_M, WIDTH_M, HEIGHT_M, CLEARANCE_M = 4.3, 1.8, 1.5, 0.2
NEAREST_M, SPACING_M = 9.0, 9.0  # distance of the first car; distance between cars
SWAY_M, SLOWEST_SWAY_S, FASTEST_SWAY_S = 2.0, 4.0, 12.0  # longitudinal sway around its position


@dataclass(frozen=True)
class Traffic:
    """Cars that move with the vehicle, each swaying around a position ahead or behind."""

    ahead_m: Matrix  # (C,) ahead of the vehicle
    side_m: Matrix  # (C,) left of the centre of the road
    period_s: Matrix  # (C,) sway period

    @classmethod
    def of(cls, cars: int, generator: np.random.Generator) -> Traffic:
        """Return this many cars, alternately ahead and behind."""
        rank = np.arange(cars)
        way = np.where(rank % 2 == 0, 1.0, -1.0)
        return cls(
            way * (NEAREST_M + SPACING_M * (rank // 2)),
            generator.uniform(-0.5, 0.5, cars),
            generator.uniform(SLOWEST_SWAY_S, FASTEST_SWAY_S, cars),
        )

    def in_street(self, street: Street, vehicle_x_m: float, time_s: float) -> Street:
        """Return the street with the cars at a time."""
        sway_m = SWAY_M * np.sin(2.0 * np.pi * time_s / self.period_s)
        x = vehicle_x_m + self.ahead_m + sway_m
        bottom, top = np.full_like(x, CLEARANCE_M), np.full_like(x, HEIGHT_M)
        half = 0.5 * WIDTH_M
        lower = np.stack([x - 0.5 * LENGTH_M, self.side_m - half, bottom], axis=1)
        upper = np.stack([x + 0.5 * LENGTH_M, self.side_m + half, top], axis=1)
        return replace(
            street,
            lower=np.concatenate([street.lower, lower]),
            upper=np.concatenate([street.upper, upper]),
        )
