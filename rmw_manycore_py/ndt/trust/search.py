# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""Searches a region for places where a scan fits, and checks whether the best one is unique.

```
 grid of places and directions ─► thinned scan, to the coarse level alone ─► the best dozens
   ─► whole scan, to all levels ─► places that differ, best first ─► margin over the second
```
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass

import numpy as np

from rmw_manycore_py.ndt.geometry import poses
from rmw_manycore_py.ndt.geometry.arrays import Pose, ScanPoints
from rmw_manycore_py.ndt.matching.alignment import Alignment
from rmw_manycore_py.ndt.matching.matcher import Matcher
from rmw_manycore_py.ndt.trust.score_level import ScoreLevel

STEP_M = 3.0  # grid spacing; levels of 4 m and 2 m converge from half its diagonal
TURN_RAD = np.radians(30.0)
SKETCH_POINTS = 600
FOLLOWED = 16  # grid results that are refined with the whole scan
SAME_M, SAME_RAD = 1.0, np.radians(10.0)  # closer results count as one place
MARGIN = 0.05  # minimum lead of the best place, relative to its fit

# A place also stands out if its lead is large compared with the differences of the others.
MIN_LEAD, LEAD_DEVIATIONS, MIN_PLACES = 0.01, 2.5, 5


@dataclass(frozen=True)
class Region:
    """Region to search.

    :param centre: T_map_base.
    :param any_yaw: search all headings; otherwise the centre's within 30 degrees.
    """

    centre: Pose
    radius_m: float
    any_yaw: bool

    def grid(self) -> Iterator[Pose]:
        """Yield poses such that each point of the region is within the convergence basin of one."""
        steps = np.arange(-self.radius_m, self.radius_m + 0.5 * STEP_M, STEP_M)
        turns = np.arange(0.0, 2 * np.pi - 1e-6, TURN_RAD) if self.any_yaw else (0.0, -0.4, 0.4)
        for x in steps:
            for y in steps:
                if np.hypot(x, y) > self.radius_m:
                    continue
                for turn in turns:
                    T = poses.from_xyz_rpy((x, y, 0.0))
                    T[:3, 3] += self.centre[:3, 3]
                    turned = poses.from_xyz_rpy((0.0, 0.0, 0.0), (0.0, 0.0, float(turn)))
                    T[:3, :3] = turned[:3, :3] @ self.centre[:3, :3]
                    yield T


@dataclass(frozen=True)
class Found:
    """Distinct places, best first."""

    places: tuple[Alignment, ...]

    @property
    def margin(self) -> float:
        """Return by which fraction of its fit the best place leads the second best."""
        if len(self.places) < 2:
            return 1.0 if self.places else 0.0
        best, second = (place.fit for place in self.places[:2])
        return (best - second) / best if best > 0.0 else 0.0

    def why_unclear(self, level: ScoreLevel, region: Region) -> str:
        """Return why the best place is not accepted; "" if it is.

        In a small region the right place may be missing and a wrong one be the best: the best must
        fit as well as a first pose. In a large one, the map's required score suffices.
        """
        if not self.places:
            return "the scan fits nowhere"
        best = self.places[0]
        if not best.explained_score > level.of_explained:
            if not region.any_yaw and not best.fit > level.of_first:
                return f"the best fit {best.fit:.3f} is below {level.of_first:.3f}"
            score = best.nearest_voxel_likelihood
            if not score > level.of_map:
                return f"the best score {score:.3f} is below {level.of_map:.3f}"
        if self.margin < MARGIN:
            other = self.places[1]
            apart_m = poses.distance_m(best.T_map_sensor, other.T_map_sensor)
            return f"{apart_m:.1f} m apart it fits equally well, within {100 * self.margin:.1f} %"
        return ""


def search(sketcher: Matcher, matcher: Matcher, scan: ScanPoints, region: Region) -> Found:
    """Return where in a region a scan (N, 3) [m, base frame] fits.

    :param sketcher: matcher with the coarsest level only.
    :param matcher: matcher with the whole map.
    """
    sketch = scan[:: max(1, len(scan) // SKETCH_POINTS)]
    tried = [sketcher.align_once(sketch, T, only_pose=True) for T in region.grid()]
    rough = distinct([one for one in tried if not one.is_degenerate], 0.5 * SAME_M)
    fine = [matcher.align_once(scan, one.T_map_sensor, only_pose=True) for one in rough]
    places = distinct([one for one in fine if not one.is_degenerate], SAME_M)
    return Found(tuple(matcher.explained(place, scan) for place in places[:1]) + tuple(places[1:]))


def lead_of_best(places: Sequence[Alignment]) -> tuple[bool, bool]:
    """Return whether the best of distinct places stands out from the others, and whether clearly.

    In a street of few features the others differ little from each other, too.
    """
    found = Found(tuple(places))
    if len(places) < MIN_PLACES:
        return found.margin >= MARGIN, found.margin >= MARGIN
    others = np.array([place.fit for place in places[1:]])
    least = max(MIN_LEAD * places[0].fit, LEAD_DEVIATIONS * float(np.std(others)))
    return places[0].fit - others[0] >= least, found.margin >= MARGIN


def distinct(places: Sequence[Alignment], apart_m: float) -> list[Alignment]:
    """Return the best alignment of each place, best first."""
    kept: list[Alignment] = []
    for place in sorted(places, key=lambda one: one.fit, reverse=True):
        if not any(_is_same(place, other, apart_m) for other in kept):
            kept.append(place)
            if len(kept) == FOLLOWED:
                break
    return kept


def _is_same(a: Alignment, b: Alignment, apart_m: float) -> bool:
    T_a, T_b = a.T_map_sensor, b.T_map_sensor
    near = poses.distance_m(T_a, T_b) < apart_m
    return near and poses.angle_rad(T_a, T_b) < SAME_RAD
