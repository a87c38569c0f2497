# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""Search of the places where a scan may be, by branch and bound (docs/design/ndt_search.md)."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence
from contextlib import suppress

import numpy as np

from rmw_manycore_py.native import _ndt
from rmw_manycore_py.ndt.geometry import poses
from rmw_manycore_py.ndt.geometry.arrays import Pose, ScanPoints
from rmw_manycore_py.ndt.matching.alignment import Alignment
from rmw_manycore_py.ndt.matching.kernel_options import match_options
from rmw_manycore_py.ndt.matching.sketch import Sketch
from rmw_manycore_py.ndt.matching.voxel_map import VoxelMap

YAWS = 360
KEPT_PERMILLE = 850  # fewest points of a place that is aligned, relative to the best one
AROUND_M, AROUND_YAW_RAD = 10.0, np.radians(60.0)  # of a search around a guess
FOLLOWED = 6  # its places that are aligned
FIT_WEIGHT = 0.25  # of the fit, beside the known fit: what fits needs less explanation
FARTHER_SHARE = 0.005  # by which a place a metre farther from the guess has to be better
STOREY_M = 2.0  # in height between a result and places around it: others are on another storey
SLICE_S = 0.2  # of a search, after which scans may be matched


# Works on the first or second phase of a search for some seconds; returns whether all is done.
Work = Callable[[_ndt.PlaceSearch, bool, float], bool]


def search_options(
    centre: Pose, radius_m: float, around_yaw_rad: float = np.pi
) -> _ndt.SearchOptions:
    """Return what to search: places around a pose (4, 4), in headings around its own."""
    x, y = centre[:2, 3]
    yaw_rad, per_rad = poses.to_rpy(centre)[2], YAWS / (2 * np.pi)
    first_yaw = int(np.ceil((yaw_rad - around_yaw_rad) * per_rad))
    last_yaw = int(np.floor((yaw_rad + around_yaw_rad) * per_rad))
    return _ndt.SearchOptions(
        yaws=YAWS,
        kept_permille=KEPT_PERMILLE,
        centre_m=(float(x), float(y)),
        radius_m=radius_m,
        first_yaw=first_yaw % YAWS,
        searched_yaws=min(last_yaw - first_yaw + 1, YAWS),
    )


def worked_on(work: Work, search: _ndt.PlaceSearch) -> Iterator[bool]:
    """Do a search in slices; yield True between them."""
    for descends in (False, True):
        while not work(search, descends, SLICE_S):
            yield True
        if not descends:
            search.order_roots()


def places_around(voxel_map: VoxelMap, scan: ScanPoints, guess: Pose, upright: Pose) -> list[Pose]:
    """Return the poses around a guess (4, 4) where a scan (N, 3) [m, sensor frame] may be.

    Searches on the calling thread, which takes 10 to 40 ms, and some 0.1 s more once per map.

    :param upright: (4, 4) of which roll, pitch and height count: the ground determines them.
    """
    roll, pitch, _ = poses.to_rpy(upright)
    centre = poses.from_xyz_rpy(guess[:3, 3], (roll, pitch, poses.to_rpy(guess)[2]))
    sketch = Sketch.of(scan, centre)
    if voxel_map.search_map is None or not sketch.is_enough:
        return []
    options = search_options(centre, AROUND_M, AROUND_YAW_RAD)
    on_this_thread = _ndt.SerialMatcher(match_options(voxel_map.options))
    with suppress(_ndt.NdtError):  # no memory
        search = _ndt.PlaceSearch(voxel_map.search_map, sketch.points, options)
        for _ in worked_on(on_this_thread.search, search):
            pass
        found = [sketch.pose(*place[:4]) for place in search.found(FOLLOWED)]
        return [place for place in found if abs(place[2, 3] - upright[2, 3]) < STOREY_M]
    return []


def best_place(found: Sequence[Alignment], guess: Pose) -> Alignment:
    """Return the best of explained results, less the farther it is from the guess (4, 4)."""

    def rank(one: Alignment) -> float:
        away_m = poses.distance_m(one.T_map_sensor, guess)
        return (one.known_fit + FIT_WEIGHT * one.fit) * (1.0 - FARTHER_SHARE * away_m)

    return max([one for one in found if one.converged] or found, key=rank)
