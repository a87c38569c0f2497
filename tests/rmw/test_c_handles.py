# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""Functions that rclpy never calls, called in C on the handles of rclpy's entities."""

from __future__ import annotations

import ctypes
import struct
from typing import Any

import pytest
from geometry_msgs.msg import Point
from rclpy.qos import HistoryPolicy, QoSProfile, ReliabilityPolicy
from rclpy.serialization import serialize_message
from std_srvs.srv import Trigger

from support import IS_MANYCORE
from support.nodes.handles import (
    Allocator,
    Bytes,
    rcl,
    rcl_handle,
    rcutils,
    rmw,
    rmw_handle,
    take_points,
)
from support.nodes.ros import spin_until

OK, INVALID_ARGUMENT = 0, 11
POINT_BYTES = 24  # three doubles in memory, and behind four bytes of header in CDR


class Event(ctypes.Structure):
    """rmw_event_t."""

    _fields_ = (
        ("identifier", ctypes.c_char_p),
        ("data", ctypes.c_void_p),
        ("type", ctypes.c_int),
    )


class Gid(ctypes.Structure):
    _fields_ = (("identifier", ctypes.c_char_p), ("data", ctypes.c_uint8 * 16))


class Qos(ctypes.Structure):
    """The first fields of rmw_qos_profile_t."""

    _fields_ = (
        ("history", ctypes.c_int),
        ("depth", ctypes.c_size_t),
        ("reliability", ctypes.c_int),
        ("durability", ctypes.c_int),
    )


rcutils.rcutils_get_default_allocator.restype = Allocator


@pytest.fixture
def publisher(node) -> Any:
    return node.create_publisher(Point, "points", 10)


@pytest.fixture
def subscription(node, publisher) -> ctypes.c_void_p:
    """Return a subscription that matches the publisher; no executor spins its node."""
    entity = node.create_subscription(Point, "points", print, 10)
    spin_until(node, lambda: publisher.get_subscription_count() == 1)
    return rmw_handle("subscription", entity)


def publish(publisher, count: int) -> None:
    for number in range(count):
        publisher.publish(Point(x=float(number)))


def take_until_taken(take) -> None:
    """Fast DDS delivers asynchronously, some time after publishing."""
    taken = ctypes.c_bool()
    while not taken:
        assert take(ctypes.byref(taken)) == 0


def test_take(publisher, subscription):
    publish(publisher, 2)
    for number in range(2):
        point = (ctypes.c_double * 3)()
        take_until_taken(lambda taken, p=point: rmw.rmw_take(subscription, p, taken, None))
        assert list(point) == [number, 0, 0]
    taken = ctypes.c_bool(True)
    assert rmw.rmw_take(subscription, point, ctypes.byref(taken), None) == 0
    assert not taken


def test_take_sequence(publisher, subscription):
    publish(publisher, 3)
    found: list[float] = []
    while len(found) < 3:
        found += take_points(subscription)
    assert found == [0.0, 1.0, 2.0]


def test_take_serialized_message(publisher, subscription):
    publish(publisher, 1)
    message = Bytes(allocator=rcutils.rcutils_get_default_allocator())
    address = ctypes.byref(message)
    take_until_taken(
        lambda taken: rmw.rmw_take_serialized_message(subscription, address, taken, None)
    )
    assert bytes(message.buffer[: message.length]) == serialize_message(Point())
    assert struct.unpack("<3d", bytes(message.buffer[4 : 4 + POINT_BYTES])) == (0, 0, 0)
    assert rcutils.rcutils_uint8_array_fini(address) == 0


@pytest.mark.skipif(not IS_MANYCORE, reason="Fast DDS lends only with data sharing")
def test_take_loaned_message(publisher, subscription):
    publish(publisher, 2)
    for number in range(2):
        loan = ctypes.c_void_p()
        address = ctypes.byref(loan)
        take_until_taken(
            lambda taken, a=address: rmw.rmw_take_loaned_message(subscription, a, taken, None)
        )
        assert list((ctypes.c_double * 3).from_address(loan.value)) == [number, 0, 0]
        assert rmw.rmw_return_loaned_message_from_subscription(subscription, loan) == 0


def test_an_event_is_initialized_once(publisher):
    event, handle, publication_matched = Event(), rmw_handle("publisher", publisher), 10
    codes = [
        rmw.rmw_publisher_event_init(ctypes.byref(event), handle, publication_matched)
        for _ in range(2)
    ]
    assert codes == [OK, INVALID_ARGUMENT]
    rcutils.rcutils_reset_error()


def test_gids_are_compared(node, publisher):
    other = node.create_publisher(Point, "points", 10)
    gids = [Gid(), Gid(), Gid()]
    for gid, entity in zip(gids, (publisher, publisher, other), strict=True):
        handle = rmw_handle("publisher", entity)
        assert rmw.rmw_get_gid_for_publisher(handle, ctypes.byref(gid)) == 0
    same = ctypes.c_bool()
    for gid, expected in ((gids[1], True), (gids[2], False)):
        arguments = (ctypes.byref(gids[0]), ctypes.byref(gid), ctypes.byref(same))
        assert rmw.rmw_compare_gids_equal(*arguments) == 0
        assert same.value is expected


@pytest.mark.parametrize(
    "function",
    [
        "rcl_client_request_publisher_get_actual_qos",
        "rcl_client_response_subscription_get_actual_qos",
        "rcl_service_request_subscription_get_actual_qos",
        "rcl_service_response_publisher_get_actual_qos",
    ],
)
def test_qos_of_both_directions_of_a_service(node, function):
    qos = QoSProfile(depth=7, reliability=ReliabilityPolicy.RELIABLE)
    client = node.create_client(Trigger, "ask", qos_profile=qos)
    service = node.create_service(Trigger, "ask", lambda _, reply: reply, qos_profile=qos)
    entity = client if "_client_" in function else service
    getattr(rcl, function).restype = ctypes.POINTER(Qos)
    actual = getattr(rcl, function)(rcl_handle(entity)).contents
    assert (actual.history, actual.depth) == (HistoryPolicy.KEEP_LAST, 7)
    assert actual.reliability == ReliabilityPolicy.RELIABLE
