# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""Timestamps of points in the formats of drivers."""

from __future__ import annotations

import numpy as np
import pytest
from builtin_interfaces.msg import Time
from sensor_msgs.msg import PointCloud2, PointField

from rmw_manycore_py.ndt.geometry.arrays import Matrix
from rmw_manycore_py.ndt.messages.point_cloud import CloudError, encode
from rmw_manycore_py.ndt.messages.point_times import FIELDS, TimesError, decode_timed, time_field

pytestmark = pytest.mark.unit

STAMP = Time(sec=1_700_000_000, nanosec=250_000_000)
POINTS = np.arange(12, dtype=np.float32).reshape(4, 3)
OFFSETS_S = np.array([0.0, 0.025, 0.05, 0.1])
DATATYPES = {"u4": PointField.UINT32, "f4": PointField.FLOAT32, "f8": PointField.FLOAT64}


def cloud(name: str, kind: str, times: Matrix, points: Matrix = POINTS) -> PointCloud2:
    record = np.dtype([("x", "f4"), ("y", "f4"), ("z", "f4"), (name, kind)])
    records = np.zeros(len(points), record)
    for axis, column in zip("xyz", points.T, strict=True):
        records[axis] = column
    records[name] = times
    fields = [PointField(name=n, offset=record.fields[n][1], datatype=7, count=1) for n in "xyz"]
    fields += [PointField(name=name, offset=12, datatype=DATATYPES[kind], count=1)]
    message = PointCloud2(height=1, width=len(points), point_step=record.itemsize, fields=fields)
    message.header.stamp = STAMP
    message.row_step = message.point_step * len(points)
    message.data = records.tobytes()
    return message


@pytest.mark.parametrize(
    ("name", "kind", "times"),
    [
        ("time", "f4", OFFSETS_S),
        ("t", "u4", 1e9 * OFFSETS_S),
        ("offset_time", "u4", 1e9 * OFFSETS_S),
        ("time_stamp", "u4", 1e9 * OFFSETS_S),
        ("timestamp", "f8", 1_700_000_000.25 + OFFSETS_S),
    ],
)
def test_times_are_seconds_after_the_stamp(name, kind, times):
    message = cloud(name, kind, times)
    assert time_field(message) == name
    points, found_s = decode_timed(message, name)
    np.testing.assert_array_equal(points, POINTS)
    np.testing.assert_allclose(found_s, OFFSETS_S, atol=1e-6)


NOW_S = STAMP.sec + 1e-9 * STAMP.nanosec
UNITS_S = [1.0, 1e-3, 1e-6, 1e-9]


@pytest.mark.parametrize("name", FIELDS)
@pytest.mark.parametrize("unit_s", UNITS_S)
@pytest.mark.parametrize("start_s", [0.0, -0.1, NOW_S, NOW_S - 0.1])
@pytest.mark.parametrize("kind", ["u4", "f4", "f8"])
def test_the_unit_of_times_is_seen_by_their_magnitude(name, unit_s, start_s, kind):
    """Of Livox, float64 `timestamp` is in nanoseconds since 1970."""
    points = np.ones((4000, 3), np.float32)
    offsets_s = np.linspace(0.0, 0.1, len(points))
    times = (start_s + offsets_s) / unit_s
    can_hold = {
        "u4": unit_s < 1.0 and start_s == 0.0,
        "f4": abs(start_s) < 1.0,
        "f8": True,
    }
    if not can_hold[kind]:
        return
    _, found_s = decode_timed(cloud(name, kind, times, points), name)
    expected_s = offsets_s - (0.0 if start_s in (0.0, NOW_S) else 0.1)
    np.testing.assert_allclose(found_s, expected_s, atol=1.1e-3 if kind == "u4" else 1e-6)


@pytest.mark.parametrize(
    ("kind", "times", "words"),
    [
        ("f8", [0.0, 1.0, 2.0, 5.0], "span 5, which is no scan"),
        ("f8", [0.0, 1e18, 1.7e18, 1.7e18], "span 1.7e+18"),
        ("f8", [0.0, np.nan, 0.1, 0.1], "are not finite"),
        ("f8", [5e5, 5e5 + 0.05, 5e5 + 0.08, 5e5 + 0.1], "begin at 500000, which is neither near"),
        ("u4", [0, 10, 20, 4_000_000_000], "span 4e+09"),
    ],
)
def test_times_of_no_scan_are_refused(kind, times, words):
    points, found = decode_timed(cloud("timestamp", kind, np.array(times)), "timestamp")
    np.testing.assert_array_equal(points, POINTS)
    assert isinstance(found, TimesError)
    assert words in str(found)
    assert str(found).startswith("the times of the points (timestamp) ")


@pytest.mark.parametrize(("kind", "time"), [("u4", 0), ("f8", 0.0), ("f8", NOW_S)])
def test_equal_times_are_those_of_a_flash(kind, time):
    points = np.ones((5000, 3), np.float32)
    _, found_s = decode_timed(cloud("t", kind, np.full(5000, time), points), "t")
    np.testing.assert_allclose(found_s, 0.0, atol=1e-6)


def test_points_that_are_left_out_take_their_times_along():
    broken = POINTS.copy()
    broken[1] = np.nan
    points, found_s = decode_timed(cloud("time", "f4", OFFSETS_S, broken), "time")
    np.testing.assert_array_equal(points, POINTS[[0, 2, 3]])
    np.testing.assert_allclose(found_s, OFFSETS_S[[0, 2, 3]], atol=1e-6)


def test_a_cloud_without_times():
    message = encode(POINTS, STAMP, "lidar")
    assert time_field(message) is None
    with pytest.raises(CloudError, match="no field 'time'"):
        decode_timed(message, "time")


def test_further_fields_stand_behind_the_positions():
    message = encode(POINTS, STAMP, "lidar", {"time": OFFSETS_S})
    points, found_s = decode_timed(message, "time")
    np.testing.assert_array_equal(points, POINTS)
    np.testing.assert_allclose(found_s, OFFSETS_S, atol=1e-6)
