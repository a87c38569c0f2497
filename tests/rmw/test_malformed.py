# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""Bytes that are not a valid message are dropped and counted; the node takes the next one."""

from __future__ import annotations

import ctypes
import os
import sys
from typing import Any

import pytest
from geometry_msgs.msg import Point
from rcl_interfaces.msg import Parameter, ParameterDescriptor, SetParametersResult
from rcl_interfaces.srv import DescribeParameters, SetParameters
from rclpy._rclpy_pybind11 import RMWError
from rclpy.event_handler import SubscriptionEventCallbacks
from rclpy.serialization import deserialize_message, serialize_message
from sensor_msgs.msg import JointState, PointCloud2, PointField
from std_msgs.msg import Float64MultiArray, String
from test_msgs.msg import UnboundedSequences, WStrings
from test_msgs.srv import BasicTypes

from support import IS_MANYCORE, TIMEOUT_S
from support.nodes.handles import rmw, rmw_handle, take_points
from support.nodes.ros import announce, lost_messages, spin_until

OK = 0
HUGE = 0x7FFFFFFF.to_bytes(4, "little")
HEADER = b"\x00\x01\x00\x00"  # plain CDR, little endian

FIELD = PointField(name="x", count=1)
ONE = b"\x01\x00\x00\x00"
STRING = b"\x02\x00\x00\x00x\x00"  # "x" in CDR

# Each a message, and the replacement of a part of its CDR.
BROKEN = {
    "length_of_a_string": (String(data="x"), STRING[:4], HUGE),
    "length_of_numbers": (
        Float64MultiArray(data=[1.0]),
        b"\x01\x00\x00\x00\x00\x00",
        HUGE + b"\0\0",
    ),
    "length_of_strings": (JointState(name=["x"]), b"\x01\x00\x00\x00" + STRING, HUGE + STRING),
    "length_inside": (PointCloud2(fields=[FIELD]), STRING[:4], HUGE),
    "length_of_messages": (
        PointCloud2(fields=[FIELD]),
        b"\x01\x00\x00\x00" + STRING,
        HUGE + STRING,
    ),
    "length_of_a_wide_string": (WStrings(wstring_value="y"), b"\x01\x00\x00\x00y", HUGE + b"y"),
    "length_of_flags": (UnboundedSequences(bool_values=[True]), HEADER + b"\x01", HEADER + b"\xff"),
    "encapsulation": (String(data="x"), HEADER, b"\x00\x55\x00\x00"),
    "end": (Point(), bytes(8), b""),
}

FIRST, SECOND = b"\x3d\xd8\0\0", b"\x00\xde\0\0"  # surrogates of a smiley
SMILEY = WStrings(wstring_value="\N{GRINNING FACE}")
TEXTS = {
    "first_surrogate_alone": (SMILEY, SECOND, b"x\0\0\0"),
    "second_surrogate_alone": (SMILEY, FIRST, b"x\0\0\0"),
    "surrogates_swapped": (SMILEY, FIRST + SECOND, SECOND + FIRST),
    "text_ends_within_a_pair": (SMILEY, FIRST + SECOND, b"x\0\0\0" + FIRST),
    "byte_order_mark_swapped": (SMILEY, FIRST + SECOND, b"\xfe\xff\0\0" + b"\x00\xd8\0\0"),
}
if IS_MANYCORE:  # Fast DDS hands them out, and rclpy raises
    BROKEN |= TEXTS


# Each a service type, and what breaks its request and its response.
BROKEN_CALLS = {
    "length_of_a_string": (
        BasicTypes,
        (BasicTypes.Request(string_value="x"), STRING[:4], HUGE),
        (BasicTypes.Response(string_value="x"), STRING[:4], HUGE),
    ),
    "length_inside": (
        SetParameters,
        (SetParameters.Request(parameters=[Parameter(name="x")]), STRING[:4], HUGE),
        (SetParameters.Response(results=[SetParametersResult(reason="x")]), STRING[:4], HUGE),
    ),
    "length_of_strings_and_of_messages": (
        DescribeParameters,
        (DescribeParameters.Request(names=["x"]), ONE + STRING, HUGE + STRING),
        (
            DescribeParameters.Response(descriptors=[ParameterDescriptor(name="x")]),
            ONE + STRING,
            HUGE + STRING,
        ),
    ),
    "encapsulation": (
        BasicTypes,
        (BasicTypes.Request(), HEADER, b"\x00\x55\x00\x00"),
        (BasicTypes.Response(), HEADER, b"\x00\x55\x00\x00"),
    ),
    "end": (
        BasicTypes,
        (BasicTypes.Request(string_value="x"), STRING, b""),
        (BasicTypes.Response(string_value="x"), STRING, b""),
    ),
}


def broken(case: tuple[Any, bytes, bytes]) -> tuple[Any, bytes]:
    """Return a message and its broken CDR."""
    message, found, put = case
    cdr = serialize_message(message)
    assert found in cdr
    return message, cdr.replace(found, put, 1)


@pytest.mark.parametrize("case", BROKEN)
def test_a_node_goes_on(node, case):
    message, cdr = broken(BROKEN[case])
    received: list[Any] = []
    publisher = node.create_publisher(type(message), "broken", 10)
    node.create_subscription(type(message), "broken", received.append, 10)
    spin_until(node, publisher.get_subscription_count)
    for data in (cdr, message, cdr, cdr, message):
        publisher.publish(data)
    spin_until(node, lambda: len(received) == 2)
    assert received == [message, message]
    if IS_MANYCORE:
        assert lost_messages("/broken") == 3


@pytest.mark.skipif(not IS_MANYCORE, reason="Fast DDS does not report it")
def test_dropped_messages_are_reported(node, capfd):
    """By the event of lost messages and by a line in the log, but not by one line per message."""
    _, cdr = broken(BROKEN["length_of_a_string"])
    publisher = node.create_publisher(String, "broken", 200)
    told: list[int] = []
    events = SubscriptionEventCallbacks(message_lost=lambda event: told.append(event.total_count))
    node.create_subscription(String, "broken", print, 200, event_callbacks=events)
    spin_until(node, publisher.get_subscription_count)
    for _ in range(200):
        publisher.publish(cdr)
    spin_until(node, lambda: told and told[-1] == 200)
    lines = [line for line in capfd.readouterr().err.splitlines() if "dropped" in line]
    assert 1 <= len(lines) < 200
    assert (
        f"dropped {len(cdr)} bytes on '/broken' that are not a valid std_msgs/msg/String"
        in lines[0]
    )


@pytest.mark.skipif(not IS_MANYCORE, reason="its message is not of ours")
@pytest.mark.parametrize(
    "case", ["length_of_strings", "length_of_messages", "length_of_a_wide_string"]
)
def test_lengths_are_compared_with_what_is_left_before_memory_is_asked_for(node, case):
    """The type support would resize first, by several bytes for each byte received."""
    message, cdr = broken(BROKEN[case])
    with pytest.raises(RMWError, match="claims more bytes than are left"):
        deserialize_message(cdr, type(message))


@pytest.mark.skipif(not IS_MANYCORE, reason="its message is not of ours")
@pytest.mark.parametrize("case", TEXTS)
def test_wide_strings_are_utf16(node, case):
    message, cdr = broken(BROKEN[case])
    with pytest.raises(RMWError, match="a wide string in it is not UTF-16"):
        deserialize_message(cdr, type(message))
    assert deserialize_message(serialize_message(message), type(message)) == message


@pytest.mark.parametrize("big", [False, True], ids=["little_endian", "big_endian"])
def test_lengths_are_read_in_the_order_of_their_message(node, big):
    message = JointState(name=["xyz"])
    order = "big" if big else "little"
    words = [0, 0, 1, 0, 1, 4, b"xyz\0", 0, 0, 0]  # stamp, frame (1 byte), name, remainder
    cdr = bytes([0, 0 if big else 1, 0, 0]) + b"".join(
        word if isinstance(word, bytes) else word.to_bytes(4, order) for word in words
    )
    assert deserialize_message(cdr, JointState) == message


def test_takes_in_c_find_the_next_message(node):
    """They skip broken messages and return RMW_RET_OK, in each of the ways to take."""
    _, cdr = broken(BROKEN["end"])
    publisher = node.create_publisher(Point, "broken", 10)
    entity = node.create_subscription(Point, "broken", print, 10)
    subscription = rmw_handle("subscription", entity)
    spin_until(node, publisher.get_subscription_count)
    point, taken = (ctypes.c_double * 3)(), ctypes.c_bool()
    publisher.publish(cdr)
    publisher.publish(Point(x=1.0))
    publisher.publish(cdr)
    while not taken:  # Fast DDS delivers asynchronously
        assert rmw.rmw_take(subscription, point, ctypes.byref(taken), None) == OK
    assert list(point) == [1, 0, 0]
    assert rmw.rmw_take(subscription, point, ctypes.byref(taken), None) == OK
    assert not taken


@pytest.mark.skipif(not IS_MANYCORE, reason="Fast DDS lends only with data sharing")
def test_loans_and_sequences_find_the_next_message(node):
    _, cdr = broken(BROKEN["end"])
    publisher = node.create_publisher(Point, "broken", 10)
    entity = node.create_subscription(Point, "broken", print, 10)
    subscription = rmw_handle("subscription", entity)
    spin_until(node, publisher.get_subscription_count)
    for data in (cdr, Point(x=1.0), cdr, Point(x=2.0), cdr, Point(x=3.0), cdr):
        publisher.publish(data)
    loan, taken = ctypes.c_void_p(), ctypes.c_bool()
    arguments = (ctypes.byref(loan), ctypes.byref(taken), None)
    assert rmw.rmw_take_loaned_message(subscription, *arguments) == OK
    assert taken
    assert (ctypes.c_double * 3).from_address(loan.value)[0] == 1
    assert rmw.rmw_return_loaned_message_from_subscription(subscription, loan) == OK
    assert take_points(subscription) == [2.0, 3.0]
    assert rmw.rmw_take_loaned_message(subscription, *arguments) == OK
    assert not taken
    assert lost_messages("/broken") == 4


@pytest.mark.skipif(not IS_MANYCORE, reason="sends with the transport's own binding")
@pytest.mark.parametrize("case", BROKEN_CALLS)
def test_a_server_and_a_client_go_on(node, start_peer, case):
    """A request and a response that are malformed: as if sent by a client and by a server."""
    service_type, *both = BROKEN_CALLS[case]
    (request, broken_request), (_, broken_response) = (broken(one) for one in both)
    served: list[Any] = []

    def serve(request: Any, response: Any) -> Any:
        served.append(request)
        return response

    node.create_service(service_type, "ask", serve)
    client = node.create_client(service_type, "ask")
    assert client.wait_for_service(TIMEOUT_S)
    start_peer(send_nonsense, broken_request.hex(), broken_response.hex()).wait_for("sent")
    answer = client.call_async(request)
    spin_until(node, answer.done)
    assert served == [request]
    assert lost_messages("/ask", "request") == lost_messages("/ask", "reply") == 1


def send_nonsense(request: str, response: str) -> None:
    """Send a malformed request to the server, and a malformed response to its client."""
    from rmw_manycore_py.native import _transport

    data = {"request": bytes.fromhex(request), "reply": bytes.fromhex(response)}
    process = _transport.Process(os.environ["MANYCORE_PLATFORM"])
    for end in process.endpoints_of("/ask"):
        if end.kind == "subscription":
            sender = process.publisher("/ask", end.type, end.qos, role=end.role)
            sender.publish(data[end.role], client=end.gid, number=1)
    announce("sent")
    sys.stdin.read()
