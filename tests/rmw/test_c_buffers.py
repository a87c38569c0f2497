# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""Buffers and allocators that a caller of the C interface passes."""

from __future__ import annotations

import ctypes
from typing import Any

import pytest
from geometry_msgs.msg import PoseStamped
from nav_msgs.msg import Path
from rclpy.serialization import deserialize_message, serialize_message
from sensor_msgs.msg import JointState, PointCloud2, PointField
from std_msgs.msg import Header, String
from test_msgs.msg import BasicTypes, MultiNested, Strings, UnboundedSequences, WStrings

from support import IS_MANYCORE
from support.nodes.handles import (
    ALLOCATE,
    FREE,
    RESIZE,
    ZEROED,
    Allocator,
    Bytes,
    c_message,
    rcutils,
    rmw,
    rmw_handle,
    type_support,
)
from support.nodes.ros import lost_messages, spin_until

OK, ERROR, BAD_ALLOC = 0, 1, 10

libc = ctypes.CDLL(None)
for name in ("malloc", "calloc", "realloc"):
    getattr(libc, name).restype = ctypes.c_void_p
rcutils.rcutils_error_is_set.restype = ctypes.c_bool


class FailingAllocator(Allocator):
    """An allocator that fails after some allocations."""

    def __init__(self, allocations: int = 0) -> None:
        self.left = allocations

        def grant(function: Any, *arguments: Any) -> Any:
            self.left -= 1
            return function(*map(ctypes.c_size_t, arguments)) if self.left >= 0 else None

        super().__init__(
            ALLOCATE(lambda size, _: grant(libc.malloc, size)),
            FREE(lambda pointer, _: libc.free(ctypes.c_void_p(pointer))),
            RESIZE(lambda pointer, size, _: grant(libc.realloc, pointer or 0, size)),
            ZEROED(lambda count, size, _: grant(libc.calloc, count, size)),
        )


def failed(code: int) -> int:
    """Return the code, after a check that the error state is set if and only if it is an error."""
    is_set = rcutils.rcutils_error_is_set()
    rcutils.rcutils_reset_error()
    assert is_set == (code != OK)
    return code


@pytest.mark.skipif(not IS_MANYCORE, reason="Fast DDS loses it uncounted")
@pytest.mark.parametrize(
    ("message", "code"),
    [(Bytes(allocator=FailingAllocator()), BAD_ALLOC), (Bytes(), ERROR)],
    ids=["allocation_fails", "no_allocator"],
)
def test_a_message_that_does_not_fit_into_the_buffer_counts_as_lost(node, message, code):
    publisher = node.create_publisher(String, "points", 10)
    subscription = rmw_handle("subscription", node.create_subscription(String, "points", print, 10))
    taken = ctypes.c_bool(True)

    def take(buffer: Bytes) -> int:
        arguments = (ctypes.byref(buffer), ctypes.byref(taken), None)
        return failed(rmw.rmw_take_serialized_message(subscription, *arguments))

    publisher.publish(String(data="first"))
    publisher.publish(String(data="second"))
    assert take(message) == code
    assert not taken
    assert lost_messages("/points") == 1
    room = (ctypes.c_uint8 * 100)()
    enough = Bytes(buffer=room, capacity=len(room))
    assert take(enough) == OK
    assert b"second" in bytes(room)
    assert take(enough) == OK
    assert not taken


class Endpoints(ctypes.Structure):
    """rmw_topic_endpoint_info_array_t."""

    _fields_ = (("size", ctypes.c_size_t), ("info", ctypes.c_void_p))


def test_each_failed_allocation_is_reported(node):
    node.create_publisher(String, "points", 10)
    handle = rmw_handle("node", node)
    codes = []
    while OK not in codes:
        found, allocator = Endpoints(), FailingAllocator(len(codes))
        arguments = (ctypes.byref(allocator), b"/points", False, ctypes.byref(found))
        codes.append(failed(rmw.rmw_get_publishers_info_by_topic(handle, *arguments)))
    assert found.size == 1
    assert codes == [BAD_ALLOC] * (len(codes) - 1) + [OK]
    assert len(codes) > 3
    end = rmw.rmw_topic_endpoint_info_array_fini
    assert end(ctypes.byref(found), ctypes.byref(allocator)) == OK


def path(count: int) -> Path:
    header = Header(frame_id="abc")
    return Path(header=header, poses=[PoseStamped(header=header) for _ in range(count)])


def cloud(size: int) -> PointCloud2:
    fields = [PointField(name="a" * i, datatype=2) for i in range(9)]
    return PointCloud2(fields=fields, data=bytes(size), is_dense=True)


PADDED = {
    "numbers": BasicTypes(bool_value=True, float64_value=1.0),
    "strings": Strings(string_value="abc"),
    "wide_strings": WStrings(wstring_value="abc", unbounded_sequence_of_wstrings=["a", "bc"]),
    "large_numbers": UnboundedSequences(bool_values=[True] * 1001, float64_values=[1.0] * 1000),
    "large_nested": MultiNested(),
    "large_strings": JointState(name=["abc"] * 301, position=[1.0] * 301),
    "large_wide_strings": WStrings(unbounded_sequence_of_wstrings=["abc", "d"] * 100),
    "large_messages": path(100),
    "large_bytes": cloud(10_001),
}


@pytest.mark.skipif(not IS_MANYCORE, reason="Fast DDS leaves what was there")
@pytest.mark.parametrize("case", PADDED)
def test_padding_is_zero(case):
    """Otherwise bytes of the process would go to recordings, and to the network."""
    message = PADDED[case]

    def serialized_over(byte: int) -> bytes:
        room = (ctypes.c_uint8 * 100_000)(*[byte] * 100_000)
        buffer = Bytes(buffer=room, capacity=len(room))
        with c_message(message) as pointer:
            support = type_support(type(message))
            assert rmw.rmw_serialize(pointer, support, ctypes.byref(buffer)) == OK
        return bytes(room[: buffer.length])

    assert (len(serialized_over(0)) > 1024) == case.startswith("large")
    assert serialized_over(0xAA) == serialized_over(0x55)
    assert deserialize_message(serialized_over(0xAA), type(message)) == message


@pytest.mark.skipif(not IS_MANYCORE, reason="Fast DDS leaves what was there")
@pytest.mark.parametrize("case", PADDED)
def test_padding_of_published_messages_is_zero(node, case):
    message = PADDED[case]
    received: list[bytes] = []
    node.create_subscription(type(message), "padded", received.append, 1, raw=True)
    publisher = node.create_publisher(type(message), "padded", 1)
    former = b"\xaa" * len(serialize_message(message))
    for _ in range(100):  # fills the memory of the topic
        publisher.publish(former)
    publisher.publish(message)
    spin_until(node, lambda: received)
    # Their lengths are rounded up differently.
    assert received[0].rstrip(b"\0") == serialize_message(message).rstrip(b"\0")
