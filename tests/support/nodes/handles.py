# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""The C libraries below rclpy, and the C handles of rclpy's entities."""

from __future__ import annotations

import ctypes
import sys
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import Any

from support import RMW

LIBRARIES = Path(sys.prefix, "lib")
INFO_BYTES = 128  # at least sizeof(rmw_message_info_t)

rmw = ctypes.CDLL(str(LIBRARIES / f"lib{RMW}.so"))
rcl = ctypes.CDLL(str(LIBRARIES / "librcl.so"))
rcutils = ctypes.CDLL(str(LIBRARIES / "librcutils.so"))

ALLOCATE = ctypes.CFUNCTYPE(ctypes.c_void_p, ctypes.c_size_t, ctypes.c_void_p)
FREE = ctypes.CFUNCTYPE(None, ctypes.c_void_p, ctypes.c_void_p)
RESIZE = ctypes.CFUNCTYPE(ctypes.c_void_p, ctypes.c_void_p, ctypes.c_size_t, ctypes.c_void_p)
ZEROED = ctypes.CFUNCTYPE(ctypes.c_void_p, ctypes.c_size_t, ctypes.c_size_t, ctypes.c_void_p)


class Allocator(ctypes.Structure):
    """rcutils_allocator_t."""

    _fields_ = (
        ("allocate", ALLOCATE),
        ("free", FREE),
        ("resize", RESIZE),
        ("zeroed", ZEROED),
        ("state", ctypes.c_void_p),
    )


class Bytes(ctypes.Structure):
    """rmw_serialized_message_t."""

    _fields_ = (
        ("buffer", ctypes.POINTER(ctypes.c_uint8)),
        ("length", ctypes.c_size_t),
        ("capacity", ctypes.c_size_t),
        ("allocator", Allocator),
    )


def rcl_handle(entity: Any) -> ctypes.c_void_p:
    return ctypes.c_void_p(entity.handle.pointer)


def rmw_handle(kind: str, entity: Any) -> ctypes.c_void_p:
    """Return the rmw handle of an entity; `kind` as in "rcl_publisher_get_rmw_handle"."""
    function = getattr(rcl, f"rcl_{kind}_get_rmw_handle")
    function.restype = ctypes.c_void_p
    return ctypes.c_void_p(function(rcl_handle(entity)))


def type_support(message_type: Any) -> ctypes.c_void_p:
    return ctypes.c_void_p(_pointer_of(message_type, "_TYPE_SUPPORT"))


@contextmanager
def c_message(message: Any) -> Iterator[ctypes.c_void_p]:
    """Yield a copy of a message as C has it."""
    kind = type(message)
    create = ctypes.CFUNCTYPE(ctypes.c_void_p)(_pointer_of(kind, "_CREATE_ROS_MESSAGE"))
    destroy = ctypes.CFUNCTYPE(None, ctypes.c_void_p)(_pointer_of(kind, "_DESTROY_ROS_MESSAGE"))
    convert = ctypes.PYFUNCTYPE(ctypes.c_bool, ctypes.py_object, ctypes.c_void_p)(
        _pointer_of(kind, "_CONVERT_FROM_PY")
    )
    copy = create()
    assert convert(message, copy)
    yield ctypes.c_void_p(copy)
    destroy(copy)


def _pointer_of(message_type: Any, capsule: str) -> int:
    get_pointer = ctypes.pythonapi.PyCapsule_GetPointer
    get_pointer.restype = ctypes.c_void_p
    get_pointer.argtypes = [ctypes.py_object, ctypes.c_char_p]
    if message_type.__class__._TYPE_SUPPORT is None:
        message_type.__class__.__import_type_support__()
    return int(get_pointer(getattr(message_type.__class__, capsule), None))


class _Sequence(ctypes.Structure):
    """rmw_message_sequence_t, and rmw_message_info_sequence_t."""

    _fields_ = (
        ("data", ctypes.c_void_p),
        ("size", ctypes.c_size_t),
        ("capacity", ctypes.c_size_t),
        ("allocator", ctypes.c_void_p),
    )


def take_points(subscription: ctypes.c_void_p, capacity: int = 5) -> list[float]:
    """Take all available geometry_msgs/msg/Point in one call; return their x."""
    points = [(ctypes.c_double * 3)() for _ in range(capacity)]
    data = (ctypes.c_void_p * capacity)(*(ctypes.addressof(point) for point in points))
    info_data = ctypes.create_string_buffer(capacity * INFO_BYTES)
    messages = _Sequence(ctypes.addressof(data), 0, capacity, None)
    infos = _Sequence(ctypes.addressof(info_data), 0, capacity, None)
    count = ctypes.c_size_t()
    arguments = (ctypes.byref(messages), ctypes.byref(infos), ctypes.byref(count), None)
    assert rmw.rmw_take_sequence(subscription, ctypes.c_size_t(capacity), *arguments) == 0
    assert messages.size == infos.size == count.value
    return [point[0] for point in points[: count.value]]
