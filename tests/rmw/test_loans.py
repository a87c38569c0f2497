# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""Loaned messages, which rclpy does not offer: through rcl, on the handles of its entities."""

from __future__ import annotations

import ctypes
from collections.abc import Callable
from typing import Any

import pytest
from geometry_msgs.msg import Point, PoseWithCovariance
from std_msgs.msg import Empty, String, UInt8MultiArray

from support import IS_MANYCORE
from support.nodes.handles import rcl, rcl_handle, rcutils, type_support
from support.nodes.ros import spin_until

OK, ERROR, UNSUPPORTED, TAKE_FAILED = 0, 1, 3, 401


class PointInMemory(ctypes.Structure):
    _fields_ = (("x", ctypes.c_double), ("y", ctypes.c_double), ("z", ctypes.c_double))


def point_at(address: ctypes.c_void_p) -> PointInMemory:
    assert address.value is not None
    return PointInMemory.from_address(address.value)


class Lender:
    """The loan functions of a publisher or a subscription; each returns rcl's code."""

    def __init__(self, entity: Any, message_type: Any) -> None:
        self.pointer = rcl_handle(entity)
        self.type_support = type_support(message_type)

    def _call(self, function: str, *arguments: Any) -> int:
        code = getattr(rcl, function)(self.pointer, *arguments)
        rcutils.rcutils_reset_error()
        return int(code)

    def lends(self) -> bool:
        function = rcl.rcl_publisher_can_loan_messages
        function.restype = ctypes.c_bool
        return bool(function(self.pointer))

    def borrow(self) -> tuple[int, ctypes.c_void_p]:
        loan = ctypes.c_void_p()
        code = self._call("rcl_borrow_loaned_message", self.type_support, ctypes.byref(loan))
        return code, loan

    def publish(self, loan: ctypes.c_void_p) -> int:
        return self._call("rcl_publish_loaned_message", loan, None)

    def return_unpublished(self, loan: ctypes.c_void_p) -> int:
        return self._call("rcl_return_loaned_message_from_publisher", loan)

    def take(self) -> tuple[int, ctypes.c_void_p]:
        loan = ctypes.c_void_p()
        code = self._call("rcl_take_loaned_message", ctypes.byref(loan), None, None)
        return code, loan

    def return_taken(self, loan: ctypes.c_void_p) -> int:
        return self._call("rcl_return_loaned_message_from_subscription", loan)


@pytest.fixture
def publisher(node) -> Any:
    return node.create_publisher(Point, "points", 10)


@pytest.fixture
def lender(publisher) -> Lender:
    return Lender(publisher, Point)


def receiver(node, publisher) -> Callable[[], list[Point]]:
    """Subscribe; return a function that waits for a message and returns all received so far."""
    received: list[Point] = []
    node.create_subscription(Point, "points", received.append, 10)
    spin_until(node, publisher.get_subscription_count)

    def receive() -> list[Point]:
        known = len(received)
        spin_until(node, lambda: len(received) > known)
        return received

    return receive


@pytest.mark.parametrize(
    ("message_type", "lent"),
    [(Point, True), (PoseWithCovariance, True), (String, False), (UInt8MultiArray, False)],
)
def test_types_whose_memory_is_their_cdr_are_lent(node, message_type, lent):
    lender = Lender(node.create_publisher(message_type, "topic", 10), message_type)
    assert lender.lends() == lent
    code, loan = lender.borrow()
    assert (code, loan.value is not None) == ((OK, True) if lent else (UNSUPPORTED, False))
    if lent:
        assert lender.return_unpublished(loan) == OK


def test_a_type_without_members(node):
    received = []
    publisher = node.create_publisher(Empty, "topic", 10)
    node.create_subscription(Empty, "topic", received.append, 10)
    spin_until(node, publisher.get_subscription_count)
    lender = Lender(publisher, Empty)
    if lender.lends():
        assert lender.publish(lender.borrow()[1]) == OK
        spin_until(node, lambda: received)


def test_published_loans_arrive(node, publisher, lender):
    receive = receiver(node, publisher)
    for number in range(3):
        code, loan = lender.borrow()
        assert code == OK
        point_at(loan).x, point_at(loan).y, point_at(loan).z = number, -1.5, 1e300
        assert lender.publish(loan) == OK
        assert receive()[-1] == Point(x=float(number), y=-1.5, z=1e300)


def test_loans_of_one_publisher_do_not_hold_each_other_up(node, publisher, lender):
    receive = receiver(node, publisher)
    first, second = lender.borrow()[1], lender.borrow()[1]
    assert first.value != second.value
    point_at(first).x, point_at(first).y, point_at(first).z = 1, 0, 0
    point_at(second).x, point_at(second).y, point_at(second).z = 2, 0, 0
    publisher.publish(Point(x=3.0))
    assert receive()[-1].x == 3
    assert lender.publish(second) == OK
    assert receive()[-1].x == 2
    assert lender.publish(first) == OK
    assert receive()[-1].x == 1


@pytest.mark.skipif(not IS_MANYCORE, reason="others lend another message")
def test_a_loan_is_not_cleared(lender):
    """That would cost as much as a copy of the message."""
    loan = lender.borrow()[1]
    point_at(loan).x = 5
    assert lender.return_unpublished(loan) == OK
    again = lender.borrow()[1]
    assert (again.value, point_at(again).x) == (loan.value, 5)
    assert lender.return_unpublished(again) == OK


@pytest.mark.skipif(not IS_MANYCORE, reason="Fast DDS crashes")
def test_a_loan_is_given_back_once(lender):
    loan = lender.borrow()[1]
    assert lender.return_unpublished(loan) == OK
    assert lender.return_unpublished(loan) == ERROR
    assert lender.publish(loan) == ERROR
    assert lender.publish(ctypes.c_void_p(ctypes.addressof(PointInMemory()))) == ERROR


def test_messages_are_taken_as_loans(node, publisher):
    subscription = node.create_subscription(Point, "points", lambda _: None, 10)
    spin_until(node, publisher.get_subscription_count)
    taker = Lender(subscription, Point)
    for number in (1, 2):
        publisher.publish(Point(x=float(number)))
    loans = []
    while len(loans) < 2:
        code, loan = taker.take()
        if code == OK:
            loans.append(loan)
    assert [point_at(loan).x for loan in loans] == [1, 2]
    code, nothing = taker.take()
    assert (code, nothing.value) == (TAKE_FAILED, None)
    for loan in loans:
        assert taker.return_taken(loan) == OK
    assert taker.return_taken(loans[0]) == ERROR


def test_taking_as_a_loan_needs_a_type_that_is_lent(node):
    subscription = node.create_subscription(String, "text", lambda _: None, 10)
    assert Lender(subscription, String).take()[0] == UNSUPPORTED
