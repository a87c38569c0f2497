# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""Per-point times of a PointCloud2, in the fields that LiDAR drivers use.

| field | of | unit |
|---|---|---|
| `time_stamp` | Autoware (PointXYZIRCAEDT) | ns, or s if not an integer |
| `timestamp` | Hesai, RoboSense | s, mostly since 1970 |
| `time` | Velodyne | s |
| `t` | Ouster | ns |
| `offset_time` | Livox | ns |
"""

from __future__ import annotations

from typing import Any

import numpy as np

from rmw_manycore_py.ndt.geometry.arrays import Matrix, Points
from rmw_manycore_py.ndt.messages.conversions import seconds
from rmw_manycore_py.ndt.messages.point_cloud import decode_with

FIELDS = ("time_stamp", "timestamp", "time", "t", "offset_time")
DECIMAL = (7, 8)  # floating-point datatypes of PointField
LONGEST_SCAN_S = 1e3  # larger values are absolute times (since 1970 or sensor start)


def time_field(message: Any) -> str | None:
    """Return the name of the field with point times; None if there is none."""
    names = {field.name for field in message.fields}
    return next((name for name in FIELDS if name in names), None)


def decode_timed(message: Any, field: str, most: int | None = None) -> tuple[Points, Matrix]:
    """Return the positions (N, 3) of a cloud, and their times (N) in seconds after its stamp.

    :param most: choose at most so many points of a larger cloud, as decode() does.
    :raises CloudError: for an invalid cloud.
    """
    points, times = decode_with(message, field, most)
    is_decimal = any(f.name == field and f.datatype in DECIMAL for f in message.fields)
    times_s: Matrix = times if is_decimal else 1e-9 * times
    if len(times_s) and np.abs(times_s).max() > LONGEST_SCAN_S:
        times_s = times_s - seconds(message.header.stamp)
    return points, times_s
