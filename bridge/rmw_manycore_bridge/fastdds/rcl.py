# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""Takes and publishes serialized messages of rclpy entities without a Python object per message.

rclpy owns contexts, nodes, publishers and subscriptions. Its raw interface copies each message
twice into and out of `bytes`; librcl, loaded by rclpy, works on caller-provided memory. The
structures mirror rcutils/types/uint8_array.h, rcutils/allocator.h and rmw/types.h.
"""

from __future__ import annotations

import ctypes
from ctypes import POINTER, Structure, byref, c_bool, c_char_p, c_int64, c_size_t, c_uint8, c_void_p
from typing import Any

from rmw_manycore_bridge.outside.interface import OutsideError

_RCL_RET_OK = 0
_RCL_RET_SUBSCRIPTION_TAKE_FAILED = 401
GID_BYTES = 16


class _Allocator(Structure):
    _fields_ = [
        ("allocate", c_void_p),
        ("deallocate", c_void_p),
        ("reallocate", c_void_p),
        ("zero_allocate", c_void_p),
        ("state", c_void_p),
    ]


class _Bytes(Structure):
    _fields_ = [
        ("buffer", c_void_p),
        ("length", c_size_t),
        ("capacity", c_size_t),
        ("allocator", _Allocator),
    ]


class _Gid(Structure):
    _fields_ = [("implementation", c_char_p), ("data", c_uint8 * GID_BYTES)]


class MessageInfo(Structure):
    """Metadata of a taken message; times in ns of CLOCK_REALTIME."""

    _fields_ = [
        ("source_timestamp", c_int64),
        ("received_timestamp", c_int64),
        ("publication_sequence_number", ctypes.c_uint64),
        ("reception_sequence_number", ctypes.c_uint64),
        ("publisher_gid", _Gid),
        ("from_intra_process", c_bool),
    ]

    @property
    def publisher(self) -> bytes:
        """Publisher gid."""
        return bytes(self.publisher_gid.data)


def _function(library: ctypes.CDLL, name: str, result: Any, *arguments: Any) -> Any:
    function = getattr(library, name)
    function.restype, function.argtypes = result, arguments
    return function


# The bare names resolve to the libraries that rclpy has loaded.
_librcl, _librcutils = ctypes.CDLL("librcl.so"), ctypes.CDLL("librcutils.so")
_int = ctypes.c_int
_default_allocator = _function(_librcutils, "rcutils_get_default_allocator", _Allocator)
_bytes_fini = _function(_librcutils, "rcutils_uint8_array_fini", _int, POINTER(_Bytes))
_reset_error = _function(_librcutils, "rcutils_reset_error", None)
_take = _function(
    _librcl,
    "rcl_take_serialized_message",
    *(_int, c_void_p, POINTER(_Bytes), POINTER(MessageInfo), c_void_p),
)
_publish = _function(
    _librcl, "rcl_publish_serialized_message", _int, c_void_p, POINTER(_Bytes), c_void_p
)
_graph_guard_condition = _function(
    _librcl, "rcl_node_get_graph_guard_condition", c_void_p, c_void_p
)
_add_guard_condition = _function(
    _librcl, "rcl_wait_set_add_guard_condition", _int, c_void_p, c_void_p, c_void_p
)
_rmw_publisher = _function(_librcl, "rcl_publisher_get_rmw_handle", c_void_p, c_void_p)


class _ErrorString(Structure):
    _fields_ = [("text", ctypes.c_char * 1024)]


_error_string = _function(_librcutils, "rcutils_get_error_string", _ErrorString)


def _check(code: int) -> None:
    if code != _RCL_RET_OK:
        text = _error_string().text.decode(errors="replace")
        _reset_error()
        raise OutsideError(text or f"rcl error {code}")


class RawReader:
    """Takes messages of an rclpy subscription into a buffer that grows to the largest message."""

    def __init__(self, subscription: Any) -> None:
        self._handle = subscription.handle
        self._pointer = self._handle.pointer
        self._bytes = _Bytes(None, 0, 0, _default_allocator())
        self.info = MessageInfo()

    def take(self) -> bool:
        """Take the next message; `address`, `size` and `info` describe it until the next call."""
        code = _take(self._pointer, byref(self._bytes), byref(self.info), None)
        if code == _RCL_RET_SUBSCRIPTION_TAKE_FAILED:
            _reset_error()
            return False
        _check(code)
        return True

    @property
    def address(self) -> int:
        """Address of the message."""
        return self._bytes.buffer or 0

    @property
    def size(self) -> int:
        """Size of the message in bytes."""
        return int(self._bytes.length)

    def close(self) -> None:
        """Free the buffer."""
        _bytes_fini(byref(self._bytes))


class RawWriter:
    """Publishes serialized messages through an rclpy publisher, in place."""

    def __init__(self, publisher: Any) -> None:
        self._handle = publisher.handle
        self._pointer = self._handle.pointer
        self._bytes = _Bytes(None, 0, 0, _default_allocator())
        self.gid = _gid_of(self._pointer)

    def publish(self, address: int, size: int) -> None:
        """Publish `size` bytes; the buffer is free afterwards."""
        self._bytes.buffer, self._bytes.length, self._bytes.capacity = address, size, size
        _check(_publish(self._pointer, byref(self._bytes), None))


def _gid_of(publisher: int) -> bytes:
    """Return the gid of an rcl publisher."""
    gid = _Gid()
    # librcl is linked to the middleware, so its symbols resolve through librcl.
    _check(_get_gid(_rmw_publisher(publisher), byref(gid)))
    return bytes(gid.data)


_get_gid = _function(_librcl, "rmw_get_gid_for_publisher", _int, c_void_p, POINTER(_Gid))


def add_graph_of(node: Any, wait_set: Any) -> None:
    """Make an rclpy wait set wake up on graph changes of a node's domain."""
    with node.handle:
        condition = _graph_guard_condition(node.handle.pointer)
        _check(_add_guard_condition(wait_set.pointer, condition, None))
