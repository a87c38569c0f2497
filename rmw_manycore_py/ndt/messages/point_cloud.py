# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""Conversions of PointCloud2 messages of any layout."""

from __future__ import annotations

from array import array
from collections.abc import Mapping, Sequence
from typing import Any, TypeAlias

import numpy as np
import numpy.typing as npt

from rmw_manycore_py.ndt.geometry.arrays import FARTHEST_M, Points
from rmw_manycore_py.ndt.geometry.precision import needs_doubles
from rmw_manycore_py.ndt.geometry.thinning import spread_indices

# Datatypes of sensor_msgs/msg/PointField.
NUMBER_OF_DATATYPE = {1: "i1", 2: "u1", 3: "i2", 4: "u2", 5: "i4", 6: "u4", 7: "f4", 8: "f8"}
FLOAT32, FLOAT64 = 7, 8
SINGLES = ("i1", "u1", "i2", "u2", "f4")  # exactly representable as float32
AXES = ("x", "y", "z")

Column: TypeAlias = npt.NDArray[Any]  # (N,)
Field: TypeAlias = tuple[int, np.dtype[Any]]  # offset and number type
Chosen: TypeAlias = npt.NDArray[np.int64]  # of all points, row by row


class CloudError(ValueError):
    """An inconsistent PointCloud2, or one without positions."""


def decode(message: Any, max_count: int | None = None) -> Points:
    """Return the positions (N, 3) of a PointCloud2, in its frame; raises CloudError.

    Accepts organised clouds, padding, any field order, byte order and number type. Drops points
    that are not finite or beyond 1e9 m. float64 if the message's are, else float32.

    :param max_count: sample this many points of a larger cloud (:func:`spread_indices`), and decode
        only these.
    """
    fields = _position_fields(message)
    flat = _positions(message, fields, _chosen(message, fields, max_count))
    is_place = places(flat)
    return flat if is_place.all() else flat[is_place]


def decode_with(message: Any, name: str, max_count: int | None = None) -> tuple[Points, Column]:
    """Return the result of decode(), and another field (N) of these points; raises CloudError."""
    if not _has_points(message):
        return np.zeros((0, 3), np.float32), np.zeros(0)
    fields = _position_fields(message)
    chosen = _chosen(message, fields, max_count)
    flat = _positions(message, fields, chosen)
    values = _columns(message, [_number(message, name)], np.float64, chosen)[:, 0]
    is_place = places(flat)
    return (flat, values) if is_place.all() else (flat[is_place], values[is_place])


def places(points: Points) -> npt.NDArray[np.bool_]:
    """Return a mask (N,) of points (N, 3) that are finite and within 1e9 m."""
    with np.errstate(invalid="ignore"):
        near: npt.NDArray[np.bool_] = np.abs(points) <= FARTHEST_M
    is_place: npt.NDArray[np.bool_] = np.all(near, axis=1)
    return is_place


def encode(
    points: Points, stamp: Any, frame_id: str, more: Mapping[str, Column] | None = None
) -> Any:
    """Return a PointCloud2 of points (N, 3), unorganised.

    x, y and z are float32, which all programs accept, unless that rounds by more than a millimetre.

    :param more: further fields (N) by name, as float32.
    """
    from sensor_msgs.msg import PointCloud2, PointField

    datatype, number = (FLOAT64, "<f8") if needs_doubles(points) else (FLOAT32, "<f4")
    size = np.dtype(number).itemsize
    message = PointCloud2(height=1, width=len(points), is_dense=True)
    message.header.stamp = stamp
    message.header.frame_id = frame_id
    message.fields = [
        PointField(name=name, offset=size * axis, datatype=datatype, count=1)
        for axis, name in enumerate(AXES)
    ]
    message.fields += [
        PointField(name=name, offset=3 * size + 4 * index, datatype=FLOAT32, count=1)
        for index, name in enumerate(more or ())
    ]
    message.point_step = 3 * size + 4 * len(more or ())
    message.row_step = message.point_step * len(points)
    data = array("B")
    data.frombytes(_bytes(np.ascontiguousarray(points, number), list((more or {}).values())))
    message.data = data
    return message


def _bytes(points: Points, more: Sequence[Column]) -> bytes:
    if not more:
        return points.tobytes()
    rows = [points.view(np.uint8)]
    rows += [np.ascontiguousarray(one, "<f4")[:, None].view(np.uint8) for one in more]
    return np.hstack(rows).tobytes()


def _position_fields(message: Any) -> list[Field]:
    return [_number(message, name) for name in AXES] if _has_points(message) else []


def _positions(message: Any, fields: list[Field], chosen: Chosen | None) -> Points:
    """Return all positions (N, 3), or the chosen ones, including non-finite ones."""
    is_single = all(number.str[1:] in SINGLES for _, number in fields)
    flat: Points = _columns(message, fields, np.float32 if is_single else np.float64, chosen)
    return flat


def _chosen(message: Any, fields: list[Field], max_count: int | None) -> Chosen | None:
    """Return the points to decode, None for all; points without return have no finite x."""
    if max_count is None or message.width * message.height <= max_count:
        return None
    (x,) = _views(message, fields[:1])
    with_return = np.flatnonzero(np.isfinite(x))
    return with_return[spread_indices(len(with_return), max_count)]


def _has_points(message: Any) -> bool:
    return bool(message.width and message.height)


def _columns(message: Any, fields: list[Field], number: Any, chosen: Chosen | None) -> Any:
    """Return fields (N, len(fields)) of all or the chosen points, converted to a number type."""
    if not fields:
        return np.zeros((0, 3), np.float32)
    shape = (message.height, message.width)
    where: Any = ... if chosen is None else np.unravel_index(chosen, shape)
    columns = [view[where].reshape(-1) for view in _views(message, fields)]
    values = np.empty((len(columns[0]), len(fields)), number)
    for index, column in enumerate(columns):
        values[:, index] = column
    return values


def _views(message: Any, fields: list[Field]) -> list[npt.NDArray[Any]]:
    """Return fields (height, width) as they lie in the message."""
    data = np.frombuffer(message.data, np.uint8)
    _check_extent(message, len(data), fields)
    shape, strides = (message.height, message.width), (message.row_step, message.point_step)
    return [np.ndarray(shape, kind, data, offset, strides) for offset, kind in fields]


def _number(message: Any, name: str) -> Field:
    """Return offset and number type of a field."""
    by_name = {field.name: field for field in message.fields}
    field = by_name.get(name)
    if field is None:
        found = ", ".join(by_name) or "none"
        raise CloudError(f"the cloud has no field '{name}'; its fields: {found}")
    number = NUMBER_OF_DATATYPE.get(field.datatype)
    if number is None:
        raise CloudError(f"the field '{name}' has the unknown datatype {field.datatype}")
    return field.offset, np.dtype((">" if message.is_bigendian else "<") + number)


def _check_extent(message: Any, size: int, fields: list[Field]) -> None:
    """Raise CloudError if points or rows overlap, or the data is too short."""
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
