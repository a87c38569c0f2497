# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""NDT scan matching: registers LiDAR scans to a map of normal distributions.

```python
from rmw_manycore_py import ndt

result = ndt.align(map_points, scan, T_map_guess)  # (N, 3) and (M, 3) in metres, (4, 4)
print(result.converged, result.score)
print(result.T_map_sensor)  # (4, 4): takes points of the sensor frame to the map frame
```
"""

from rmw_manycore_py.ndt.matching.align import align
from rmw_manycore_py.ndt.matching.alignment import Alignment, Score
from rmw_manycore_py.ndt.matching.matcher import Matcher
from rmw_manycore_py.ndt.matching.options import MatcherOptions
from rmw_manycore_py.ndt.matching.serial_matcher import SerialMatcher
from rmw_manycore_py.ndt.matching.voxel_map import VoxelMap
from rmw_manycore_py.ndt.matching.worker_matcher import WorkerMatcher

__all__ = [
    "Alignment",
    "Matcher",
    "MatcherOptions",
    "Score",
    "SerialMatcher",
    "VoxelMap",
    "WorkerMatcher",
    "align",
]
