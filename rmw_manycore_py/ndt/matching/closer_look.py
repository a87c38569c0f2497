# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""A closer look at a scan: to the finest level alone, with the points that cannot mislead.

```
 guess ─► all levels, without vehicles' heights and unknown columns ─► a start
   │         start ─► finest level, without what is unknown or foreign there, twice ─► first result
   └─► finest level, with all points ─► second result
```

The whole scan may have no maximum at the right place: sides of vehicles near a wall drag it there.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator
from dataclasses import replace

from rmw_manycore_py.ndt.geometry.arrays import Pose, ScanPoints
from rmw_manycore_py.ndt.matching.alignment import Alignment, Score
from rmw_manycore_py.ndt.matching.evidence import Evidence, known_points, sample_of
from rmw_manycore_py.ndt.matching.question import Question
from rmw_manycore_py.ndt.matching.vehicles import beyond_vehicles
from rmw_manycore_py.ndt.matching.voxel_map import VoxelMap

SAMPLE = 4000  # points that the first result is aligned with
ROUNDS = 2  # what is foreign depends on the pose; a third changes nothing


def closer_looks(
    asked: Question,
    voxel_map: VoxelMap,
    outlier_ratio: float,
    align: Callable[..., Alignment],
    score: Callable[[ScanPoints, Pose], Score],
) -> Iterator[Alignment]:
    """Yield the results, each computed when it is asked for.

    :param align: `Matcher._aligned`.
    :param score: scores a scan (N, 3) at a pose (4, 4).
    """
    seen = beyond_vehicles(asked.scan, asked.guess)
    seen = known_points(voxel_map.finest, seen, asked.guess)
    found = align(replace(asked, scan=seen), polish=False)
    sample = sample_of(asked.scan, SAMPLE)
    for turn in range(ROUNDS):
        if found.is_degenerate:
            break
        evidence = Evidence.of(voxel_map, sample, found.T_map_sensor, outlier_ratio)
        there = replace(asked, scan=sample[evidence.rest], guess=found.T_map_sensor)
        closer = align(there, is_close=True, polish=turn == ROUNDS - 1)
        found = closer.continued_from(found)
    else:
        yield found.scored(score(asked.scan, found.T_map_sensor), len(asked.scan))
    yield align(asked, is_close=True)
