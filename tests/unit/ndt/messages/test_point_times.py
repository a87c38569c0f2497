# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""Timestamps of points in the formats of drivers."""

from __future__ import annotations

import numpy as np
import pytest
from builtin_interfaces.msg import Time
from sensor_msgs.msg import PointCloud2, PointField

from rmw_manycore_py.ndt.geometry.arrays import Matrix
from rmw_manycore_py.ndt.messages.point_cloud import CloudError, encode
from rmw_manycore_py.ndt.messages.point_times import decode_timed, time_field

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
