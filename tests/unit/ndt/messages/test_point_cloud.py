# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""PointCloud2 in the layouts of drivers, and in invalid ones."""

from __future__ import annotations

from array import array

import numpy as np
import pytest
from builtin_interfaces.msg import Time
from sensor_msgs.msg import PointCloud2, PointField

from rmw_manycore_py.ndt.messages.point_cloud import (
    CloudError,
    decode,
    decode_with,
    encode,
)

pytestmark = pytest.mark.unit

POINTS = np.arange(36, dtype=np.float32).reshape(12, 3) - 17.5
VELODYNE = np.dtype(
    {
        "names": ["x", "y", "z", "intensity", "ring", "time"],
        "formats": ["f4", "f4", "f4", "f4", "u2", "f4"],
        "offsets": [0, 4, 8, 16, 20, 24],
        "itemsize": 32,
    }
)
DATATYPES = {"i2": 3, "u2": 4, "i4": 5, "f4": 7, "f8": 8}


def cloud_of(records: np.ndarray, height: int = 1, padding: int = 0) -> PointCloud2:
    """Return a message of a structured array, with padding at the end of each row."""
    fields = []
    for name, (dtype, offset) in records.dtype.fields.items():
        code = DATATYPES[dtype.newbyteorder("<").str[1:]]
        fields.append(PointField(name=name, offset=offset, datatype=code, count=1))
    rows = records.reshape(height, -1)
    raw = np.zeros((height, rows.shape[1] * records.dtype.itemsize + padding), np.uint8)
    raw[:, : raw.shape[1] - padding] = rows.view(np.uint8).reshape(height, -1)
    return PointCloud2(
        height=height,
        width=rows.shape[1],
        fields=fields,
        is_bigendian=records.dtype["x"].byteorder == ">",
        point_step=records.dtype.itemsize,
        row_step=raw.shape[1],
        data=array("B", raw.tobytes()),
    )


def records_of(dtype: np.dtype) -> np.ndarray:
    records = np.zeros(len(POINTS), dtype)
    for axis, name in enumerate("xyz"):
        records[name] = POINTS[:, axis]
    return records


@pytest.mark.parametrize("height", [1, 3])
@pytest.mark.parametrize("padding", [0, 5])
def test_ring_and_organised(height, padding):
    np.testing.assert_array_equal(decode(cloud_of(records_of(VELODYNE), height, padding)), POINTS)


@pytest.mark.parametrize("number", ["<f4", ">f4", "<f8", ">f8"])
def test_number_types_and_order_of_fields(number):
    dtype = np.dtype([("intensity", "u2"), ("z", number), ("x", number), ("y", number)])
    np.testing.assert_array_equal(decode(cloud_of(records_of(dtype))), POINTS)


def test_nan_and_infinite_points_are_left_out():
    records = records_of(VELODYNE)
    records["x"][2], records["z"][5], records["y"][7] = np.nan, np.inf, -np.inf
    kept = np.delete(POINTS, [2, 5, 7], axis=0)
    np.testing.assert_array_equal(decode(cloud_of(records, 3)), kept)


@pytest.mark.parametrize(("height", "padding"), [(1, 0), (200, 5)])
def test_of_a_large_cloud_as_many_points_with_a_return_are_chosen(height, padding):
    """Evenly spread over those that have one, with their own values of another field."""
    records = np.zeros(20_000, VELODYNE)
    records["x"] = records["time"] = np.arange(20_000)
    records["x"][::2] = np.nan
    records["y"][101] = np.inf
    message = cloud_of(records, height, padding)
    points, times = decode_with(message, "time", max_count=1000)
    np.testing.assert_array_equal(points[:, 0], times)
    assert len(points) in (999, 1000)
    assert np.all(np.diff(times) > 0)
    assert np.diff(times).max() < 4 * 20
    np.testing.assert_array_equal(decode(message, max_count=1000), points)
    assert len(decode(message, max_count=20_000)) == len(decode(message)) == 9_999


def test_all_nan_and_empty():
    records = records_of(VELODYNE)
    records["x"] = np.nan
    assert decode(cloud_of(records)).shape == (0, 3)
    assert decode(PointCloud2()).shape == (0, 3)


def test_there_and_back():
    message = encode(POINTS, Time(sec=3), "map")
    assert (message.header.frame_id, message.header.stamp.sec) == ("map", 3)
    np.testing.assert_array_equal(decode(message), POINTS)


def test_far_from_the_origin_there_and_back():
    """Maps in UTM coordinates need doubles; near the origin float32 is what programs expect."""
    far = POINTS.astype(np.float64) / 7.0 + (500_000.0, 5_000_000.0, 100.0)
    message = encode(far, Time(), "map")
    assert (message.point_step, message.fields[0].datatype) == (24, PointField.FLOAT64)
    np.testing.assert_array_equal(decode(message), far)
    message = encode(POINTS.astype(np.float64), Time(), "map")
    assert (message.point_step, message.fields[0].datatype) == (12, PointField.FLOAT32)


def test_points_that_are_nowhere_are_left_out():
    records = records_of(np.dtype([(name, "<f8") for name in "xyz"]))
    records["x"][2], records["z"][5] = 1e300, -2e9
    np.testing.assert_array_equal(decode(cloud_of(records)), np.delete(POINTS, [2, 5], axis=0))


def wrong(**changes: object) -> PointCloud2:
    message = cloud_of(records_of(VELODYNE), 3)
    for name, value in changes.items():
        setattr(message, name, value)
    return message


@pytest.mark.parametrize(
    ("message", "words"),
    [
        (wrong(fields=[]), "no field 'x'; its fields: none"),
        (wrong(data=array("B", b"12")), "need 384 bytes of data, found 2"),
        (wrong(width=1000000), "rows of 128 bytes"),
        (wrong(height=4000000000), "need"),
        (wrong(point_step=8), "ends at byte 12"),
        (wrong(fields=[PointField(name=n, datatype=99) for n in "xyz"]), "unknown datatype 99"),
    ],
)
def test_wrong_layouts_are_refused(message, words):
    with pytest.raises(CloudError, match=words):
        decode(message)
