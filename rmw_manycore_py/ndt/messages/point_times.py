# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""Per-point times of a PointCloud2, in the fields that LiDAR drivers use.

| field | of | unit |
|---|---|---|
| `time_stamp` | Autoware (PointXYZIRCAEDT) | ns, or s if not an integer |
| `timestamp` | Hesai, RoboSense; Livox | s, mostly since 1970; ns |
| `time` | Velodyne | s |
| `t` | Ouster | ns |
| `offset_time` | Livox | ns |

Drivers disagree on units. The unit is one in which the times span one scan: if possible, the usual
one of the datatype.
"""

from __future__ import annotations

from typing import Any

import numpy as np

from rmw_manycore_py.ndt.geometry.arrays import Matrix, Points
from rmw_manycore_py.ndt.messages.conversions import seconds
from rmw_manycore_py.ndt.messages.point_cloud import decode_with

FIELDS = ("time_stamp", "timestamp", "time", "t", "offset_time")
DECIMAL = (7, 8)  # floating-point datatypes of PointField
# Seconds per unit, the usual one of the datatype first.
DECIMAL_UNITS = (1.0, 1e-9, 1e-6, 1e-3)
WHOLE_UNITS = (1e-9, 1e-6, 1e-3, 1.0)
MAX_SCAN_S = 2.0  # also the maximum time between its stamp and a point
# Of a scan whose times are in an unusual unit.
MIN_ODD_SCAN_S, MAX_ODD_SCAN_S = 0.01, 1.0
MAX_POINTS_HZ = 2e7  # above the point rate of any LiDAR


class TimesError(ValueError):
    """Times of points that do not fit one scan."""


def time_field(message: Any) -> str | None:
    """Return the name of the field with point times; None if there is none."""
    names = {field.name for field in message.fields}
    return next((name for name in FIELDS if name in names), None)


def decode_timed(
    message: Any, field: str, max_count: int | None = None
) -> tuple[Points, Matrix | TimesError]:
    """Return the positions (N, 3) of a cloud, and their times (N) in seconds after its stamp.

    :param max_count: sample a larger cloud, as decode() does.
    :returns: an error in place of times that do not fit one scan; the points are usable.
    :raises CloudError: for an invalid cloud.
    """
    points, times = decode_with(message, field, max_count)
    is_decimal = any(f.name == field and f.datatype in DECIMAL for f in message.fields)
    units = DECIMAL_UNITS if is_decimal else WHOLE_UNITS
    try:
        stamp_s = seconds(message.header.stamp)
        return points, _after_stamp(times, stamp_s, units, message.width * message.height)
    except TimesError as error:
        return points, TimesError(f"the times of the points ({field}) {error}")


def _after_stamp(times: Matrix, stamp_s: float, units: tuple[float, ...], count: int) -> Matrix:
    """Return times (N) in seconds after a stamp; raise TimesError if no unit fits.

    :param count: points of the whole cloud.
    """
    if not len(times):
        return times
    if not np.isfinite(times).all():
        raise TimesError("are not finite")
    # Differences first, so that nanoseconds since 1970 keep their digits.
    start = float(times.min())
    after_start = times - start
    span = float(after_start.max())
    fitting = [unit_s for unit_s in units if _is_scan(span * unit_s, count, unit_s == units[0])]
    # A few points, as of a narrow view, may have taken less time than any scan.
    fitting += [units[0]] if span * units[0] <= MAX_SCAN_S else []
    for unit_s in fitting:
        for origin_s in (0.0, stamp_s):
            shift_s = start * unit_s - origin_s
            if abs(shift_s) <= MAX_SCAN_S:
                after_stamp: Matrix = after_start * unit_s + shift_s
                return after_stamp
    if fitting:
        raise TimesError(f"begin at {start:.6g}, which is neither near zero nor near the stamp")
    raise TimesError(f"span {span:.6g}, which is no scan in s, ms, us or ns")


def _is_scan(span_s: float, count: int, is_usual: bool) -> bool:
    if is_usual:
        return span_s <= MAX_SCAN_S and count <= 1 + MAX_POINTS_HZ * span_s
    return MIN_ODD_SCAN_S <= span_s <= MAX_ODD_SCAN_S
