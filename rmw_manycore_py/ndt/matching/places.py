# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""Search of the places where a scan may be, by branch and bound (docs/design/ndt_search.md)."""

from __future__ import annotations

from collections.abc import Iterator
from typing import Protocol

import numpy as np

from rmw_manycore_py.native import _ndt
from rmw_manycore_py.ndt.geometry import poses
from rmw_manycore_py.ndt.geometry.arrays import Pose, ScanPoints
from rmw_manycore_py.ndt.matching.sketch import Sketch

YAWS = 360
KEPT_PERMILLE = 850  # fewest points of a place that is aligned, relative to the best one
AROUND_M, AROUND_YAW_RAD = 10.0, np.radians(60.0)  # of a search around a guess
FOLLOWED = 6  # its places that are aligned
SLICE_S = 0.2  # of a search, after which scans may be matched


class Searcher(Protocol):
    """A matcher that works on searches."""

    def work_on(self, search: _ndt.PlaceSearch, *, descends: bool, for_s: float) -> bool:
        """Work on a phase for some time; return whether all of it is done."""
        ...


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


def worked_on(matcher: Searcher, search: _ndt.PlaceSearch) -> Iterator[bool]:
    """Do a search in slices; yield True between them."""
    for descends in (False, True):
        while not matcher.work_on(search, descends=descends, for_s=SLICE_S):
            yield True
        if not descends:
            search.order_roots()


def places_around(
    matcher: Searcher, search_map: _ndt.SearchMap, scan: ScanPoints, centre: Pose
) -> list[Pose]:
    """Return the poses around a guess (4, 4), with its roll and pitch, where a scan may be."""
    sketch = Sketch.of(scan, centre)
    if not sketch.is_enough:
        return []
    options = search_options(centre, AROUND_M, AROUND_YAW_RAD)
    search = _ndt.PlaceSearch(search_map, sketch.points, options)
    for _ in worked_on(matcher, search):
        pass
    return [sketch.pose(*place[:4]) for place in search.found(FOLLOWED)]
