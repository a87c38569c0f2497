# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""PointCloud2 messages of any layout to arrays and back."""

from __future__ import annotations

from array import array
from typing import Any

import numpy as np

from rmw_manycore_py.ndt.geometry.arrays import FARTHEST_M, Points
from rmw_manycore_py.ndt.geometry.precision import needs_doubles

# sensor_msgs/msg/PointField
NUMBER_OF_DATATYPE = {1: "i1", 2: "u1", 3: "i2", 4: "u2", 5: "i4", 6: "u4", 7: "f4", 8: "f8"}
FLOAT32, FLOAT64 = 7, 8
SINGLES = ("i1", "u1", "i2", "u2", "f4")  # fit into single precision
AXES = ("x", "y", "z")


class CloudError(ValueError):
    """A PointCloud2 that contradicts itself or has no positions."""


def decode(message: Any) -> Points:
    """Return the positions (N, 3) of a PointCloud2, in its frame.

    Organised or not, with padding, other fields in any order, either byte order, any number type;
    Points that are not finite, or beyond 1e9 m, are left out. They are doubles where the message
    has such. Raises CloudError.
    """
    width, height = message.width, message.height
    data = np.frombuffer(message.data, np.uint8)
    if width == 0 or height == 0:
        return np.zeros((0, 3), np.float32)
    fields = _fields(message)
    _check_extent(message, len(data), fields)
    is_single = all(number.str[1:] in SINGLES for _, number in fields)
    points = np.empty((height, width, 3), np.float32 if is_single else np.float64)
    for axis, (offset, number) in enumerate(fields):
        points[:, :, axis] = np.ndarray(
            (height, width), number, data, offset, (message.row_step, message.point_step)
        )
    flat = points.reshape(-1, 3)
    with np.errstate(invalid="ignore"):
        is_place = (np.abs(flat) <= FARTHEST_M).all(axis=1)
    return flat if is_place.all() else flat[is_place]


def encode(points: Points, stamp: Any, frame_id: str) -> Any:
    """Return a PointCloud2 of points (N, 3), unorganised.

    x, y and z are float32, as all programs take them, unless that rounds by more than a millimetre.
    """
    from sensor_msgs.msg import PointCloud2, PointField

    datatype, number = (FLOAT64, "<f8") if needs_doubles(points) else (FLOAT32, "<f4")
    size = np.dtype(number).itemsize
    message = PointCloud2(height=1, width=len(points), point_step=3 * size, is_dense=True)
    message.header.stamp = stamp
    message.header.frame_id = frame_id
    message.row_step = message.point_step * len(points)
    message.fields = [
        PointField(name=name, offset=size * axis, datatype=datatype, count=1)
        for axis, name in enumerate(AXES)
    ]
    data = array("B")
    data.frombytes(np.ascontiguousarray(points, number).tobytes())
    message.data = data
    return message


def _fields(message: Any) -> list[tuple[int, np.dtype[Any]]]:
    """Return offset and number type of x, y and z."""
    order = ">" if message.is_bigendian else "<"
    by_name = {field.name: field for field in message.fields}
    fields = []
    for name in AXES:
        field = by_name.get(name)
        if field is None:
            found = ", ".join(by_name) or "none"
            raise CloudError(f"the cloud has no field '{name}'; its fields: {found}")
        number = NUMBER_OF_DATATYPE.get(field.datatype)
        if number is None:
            raise CloudError(f"the field '{name}' has the unknown datatype {field.datatype}")
        fields.append((field.offset, np.dtype(order + number)))
    return fields


def _check_extent(message: Any, size: int, fields: list[tuple[int, np.dtype[Any]]]) -> None:
    """Raise where points or rows overlap, or the data is too short."""
    width, height = message.width, message.height
    last = max(offset + number.itemsize for offset, number in fields)
    if last > message.point_step:
        raise CloudError(f"a field ends at byte {last} of points of {message.point_step} bytes")
    if height > 1 and message.row_step < width * message.point_step:
        raise CloudError(
            f"rows of {message.row_step} bytes cannot hold {width} points of "
            f"{message.point_step} bytes"
        )
    needed = (height - 1) * message.row_step + width * message.point_step
    if size < needed:
        raise CloudError(f"{width} x {height} points need {needed} bytes of data, found {size}")
