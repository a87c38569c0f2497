# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""C messages of rclpy that are taken but not converted give back their records."""

from __future__ import annotations

import array
import ctypes
import os
from typing import Any

import pytest
from std_msgs.msg import UInt8MultiArray

from rmw_manycore_py.native._transport import Platform
from support import IS_MANYCORE, wait_until
from support.nodes.exchanging import large, status_of_child
from support.nodes.handles import rcl, rcl_handle
from support.nodes.ros import spin_until

pytestmark = pytest.mark.skipif(not IS_MANYCORE, reason="others copy")

TOPIC = "/large"
OK = 0


def capsule(name: str, prototype: Any) -> Any:
    """Return a function in a capsule of the message class, as rclpy calls it."""
    found = getattr(type(UInt8MultiArray), name)
    get_name, get_pointer = (
        ctypes.pythonapi.PyCapsule_GetName,
        ctypes.pythonapi.PyCapsule_GetPointer,
    )
    get_name.restype, get_name.argtypes = ctypes.c_char_p, [ctypes.py_object]
    get_pointer.restype = ctypes.c_void_p
    get_pointer.argtypes = [ctypes.py_object, ctypes.c_char_p]
    return prototype(get_pointer(found, get_name(found)))


class CMessage:
    """A message of rclpy before its conversion."""

    def __init__(self) -> None:
        create = capsule("_CREATE_ROS_MESSAGE", ctypes.CFUNCTYPE(ctypes.c_void_p))
        self.address = ctypes.c_void_p(create())
        self._destroy = capsule("_DESTROY_ROS_MESSAGE", ctypes.CFUNCTYPE(None, ctypes.c_void_p))

    def take(self, subscription: Any) -> None:
        pointer = rcl_handle(subscription)
        wait_until(lambda: rcl.rcl_take(pointer, self.address, None, None) == OK, "a message")

    def destroy(self) -> None:
        self._destroy(self.address)


@pytest.fixture
def publish(node) -> Any:
    publisher = node.create_publisher(UInt8MultiArray, "large", 10)
    subscription = node.create_subscription(UInt8MultiArray, "large", lambda _: None, 10)
    spin_until(node, publisher.get_subscription_count)

    def publish(values: Any) -> Any:
        publisher.publish(UInt8MultiArray(data=values))
        return subscription

    return publish


def held_bytes() -> int:
    """Return the memory of large messages that readers hold."""
    with Platform(os.environ["MANYCORE_PLATFORM"]) as platform:
        found = platform.endpoints()
    return sum(e.held_bytes for e in found if e.topic == TOPIC and e.kind == "publisher")


def test_a_destroyed_message_gives_back_its_record(publish):
    message = CMessage()
    message.take(publish(large()))
    assert held_bytes() >= len(large())
    message.destroy()
    assert held_bytes() == 0


@pytest.mark.filterwarnings("ignore:.*multi-threaded, use of fork:DeprecationWarning")
def test_a_child_gives_back_nothing_of_its_parent(publish):
    message = CMessage()
    message.take(publish(large()))
    assert status_of_child(message.destroy) == 0
    assert held_bytes() >= len(large())
    message.destroy()
    assert held_bytes() == 0


@pytest.mark.parametrize("second", [array.array("B", b"small"), large(seed=1)])
def test_a_message_that_is_taken_into_twice_gives_back_its_first_record(publish, second):
    message = CMessage()
    message.take(publish(large()))
    first = held_bytes()
    message.take(publish(second))
    assert held_bytes() == (first if len(second) == len(large()) else 0)
    message.destroy()
    assert held_bytes() == 0
