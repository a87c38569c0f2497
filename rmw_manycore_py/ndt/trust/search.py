# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""Searches a region for places where a scan fits, and checks whether the best one is unique.

```
 places of a metre and a degree ─► upright scan, by branch and bound ─► the best dozen
   ─► closer look at the whole scan ─► places that differ, best first ─► margin over the second
```
"""

from __future__ import annotations

from collections.abc import Callable, Generator, Sequence
from dataclasses import dataclass, replace

import numpy as np

from rmw_manycore_py.native import _ndt
from rmw_manycore_py.native.errors import translate_native_errors
from rmw_manycore_py.ndt.geometry import poses
from rmw_manycore_py.ndt.geometry.arrays import Pose, ScanPoints
from rmw_manycore_py.ndt.matching.alignment import Alignment
from rmw_manycore_py.ndt.matching.matcher import Matcher
from rmw_manycore_py.ndt.matching.places import search_options, worked_on
from rmw_manycore_py.ndt.matching.sketch import Sketch
from rmw_manycore_py.ndt.trust.score_level import ScoreLevel

FOLLOWED = 16  # places that are aligned with the whole scan
AROUND_YAW_RAD = np.radians(45.0)  # of a region without any_yaw
TILT_RAD = np.radians(15.0)  # of a result, against the gravity that is known
SAME_M, SAME_RAD = 1.0, np.radians(10.0)  # closer results count as one place
MARGIN = 0.05  # minimum lead of the best place, as a share of its known fit
ONLY_SHARE = 0.95  # of the fit of a first pose: that of a place which stands out

# A place also stands out if its lead is large compared with the differences of the others.
MIN_LEAD, LEAD_DEVIATIONS, MIN_PLACES = 0.01, 2.5, 5


@dataclass(frozen=True)
class Region:
    """Region to search.

    :param centre: T_map_base; its roll and pitch are those of the vehicle.
    :param radius_m: infinity for the whole map.
    :param any_yaw: search all headings; otherwise those within 45 degrees of the centre's.
    """

    centre: Pose
    radius_m: float
    any_yaw: bool

    def options(self) -> _ndt.SearchOptions:
        """Return what is searched."""
        around_rad = np.pi if self.any_yaw else AROUND_YAW_RAD
        return search_options(self.centre, self.radius_m, around_rad)


@dataclass(frozen=True)
class Found:
    """Distinct places, in the order of their known fit, the best first."""

    places: tuple[Alignment, ...]

    @property
    def margin(self) -> float:
        """Return by which share of its known fit the best place leads the second best."""
        return _lead([place.known_fit for place in self.places])

    def why_unclear(
        self,
        level: ScoreLevel,
        region: Region,
        other: Found | None = None,
        *,
        is_first: bool = False,
    ) -> str:
        """Return why the best place is not accepted; "" if it is.

        The right place may be outside of the region, and a wrong one the best. So the best must be
        explained like a first pose, or fit as well; nearly as well in a region of any yaw, which is
        large enough to contain places like it, or where another search leads to it, too.

        :param other: what the search of another region found for this vehicle.
        :param is_first: no pose was believed: a search of headings around the guess only confirms.
        """
        if not self.places:
            return "the scan fits nowhere"
        best = self.places[0]
        is_confirmed = other is not None and other.leads_to(best)
        least = level.of_confirmed if is_confirmed else level.of_explained
        min_fit = level.of_first * (ONLY_SHARE if region.any_yaw or is_confirmed else 1.0)
        if not (best.fit > min_fit or best.explained_score > least):
            return f"the best explained score {best.explained_score:.3f} is below {least:.3f}"
        if self.margin < MARGIN:
            second = self.places[1]
            apart_m = poses.distance_m(best.T_map_sensor, second.T_map_sensor)
            return f"{apart_m:.1f} m apart it fits equally well, within {100 * self.margin:.1f} %"
        if is_first and not (region.any_yaw or is_confirmed):
            return "in a larger region it is not the best"
        return ""

    def moved(self, motion: Pose) -> Found:
        """Return the places of the vehicle after a motion (4, 4)."""
        return Found(
            tuple(replace(one, T_map_sensor=one.T_map_sensor @ motion) for one in self.places)
        )

    def leads_to(self, place: Alignment) -> bool:
        """Return whether a place is the best of these, and stands out."""
        is_best = bool(self.places) and _is_same(self.places[0], place, SAME_M)
        return is_best and self.margin >= MARGIN


def search(matcher: Matcher, scan: ScanPoints, region: Region) -> Found:
    """Return where in a region of the matcher's map a scan (N, 3) [m, base frame] fits."""
    steps = search_steps(matcher, scan, region)
    while True:
        try:
            next(steps)
        except StopIteration as end:
            found: Found = end.value
            return found


def search_steps(
    matcher: Matcher,
    scan: ScanPoints,
    region: Region,
    make_room: Callable[[int], None] = lambda _: None,
) -> Generator[bool, None, Found]:
    """Search as :func:`search` does, in steps of some 0.2 s.

    :param make_room: called with the bytes that are shared with workers, before they are used.
    """
    sketch = Sketch.of(scan, region.centre)
    rough: list[Pose] = []
    if sketch.is_enough:
        rough = yield from _promising(matcher, sketch, region, make_room)
    fine: list[Alignment] = []
    for start in rough:
        once = matcher.align_once(scan, start, only_pose=True)
        for one in (once, *matcher.closer_looks(scan, start, only_pose=True)):
            if not one.is_degenerate and _is_upright(one.T_map_sensor, start):
                fine.append(one)
        yield True
    explained = [matcher.explained(place, scan) for place in fine]
    return Found(tuple(distinct(explained, SAME_M, lambda place: place.known_fit)))


def _promising(
    matcher: Matcher, sketch: Sketch, region: Region, make_room: Callable[[int], None]
) -> Generator[bool, None, list[Pose]]:
    """Find the poses at which most points of a sketch are at something in the map, best first."""
    voxel_map, options = matcher.map.finest, region.options()
    with translate_native_errors("the search"):
        map_bytes = _ndt.SearchMap.bytes_for(voxel_map)
        make_room(map_bytes)
        search_map = _ndt.SearchMap(voxel_map)
        points = len(sketch.points)
        make_room(map_bytes + _ndt.PlaceSearch.bytes_for(search_map, points, options))
        places = _ndt.PlaceSearch(search_map, sketch.points, options)
    yield from worked_on(matcher.work_on, places)
    return [sketch.pose(*place[:4]) for place in places.found(FOLLOWED)]


def _is_upright(T: Pose, start: Pose) -> bool:
    """Return whether an alignment kept roll and pitch of its start."""
    return bool(T[2, :3] @ start[2, :3] > np.cos(TILT_RAD))


def lead_of_best(places: Sequence[Alignment]) -> tuple[bool, bool]:
    """Return whether the best of distinct places stands out by its fit, and whether clearly.

    In a street of few features the others differ little from each other, too.
    """
    fits = [place.fit for place in places]
    is_clear = _lead(fits) >= MARGIN
    if len(places) < MIN_PLACES:
        return is_clear, is_clear
    least = max(MIN_LEAD * fits[0], LEAD_DEVIATIONS * float(np.std(fits[1:])))
    return fits[0] - fits[1] >= least, is_clear


def distinct(
    places: Sequence[Alignment], apart_m: float, rank: Callable[[Alignment], float]
) -> list[Alignment]:
    """Return the best alignment of each place, best first."""
    kept: list[Alignment] = []
    for place in sorted(places, key=rank, reverse=True):
        if not any(_is_same(place, other, apart_m) for other in kept):
            kept.append(place)
            if len(kept) == FOLLOWED:
                break
    return kept


def _lead(scores: Sequence[float]) -> float:
    """Return by which share of itself the first of falling scores leads the second."""
    if len(scores) < 2:
        return float(len(scores))
    return (scores[0] - scores[1]) / scores[0] if scores[0] > 0.0 else 0.0


def _is_same(a: Alignment, b: Alignment, apart_m: float) -> bool:
    T_a, T_b = a.T_map_sensor, b.T_map_sensor
    near = poses.distance_m(T_a, T_b) < apart_m
    return near and poses.angle_rad(T_a, T_b) < SAME_RAD
