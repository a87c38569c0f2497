# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""Features that this middleware lacks are refused; features that it announces work."""

from __future__ import annotations

import ctypes
from typing import Any

import pytest
from geometry_msgs.msg import Point

from support import IS_MANYCORE
from support.nodes.handles import rcl, rcl_handle, rcutils, rmw, rmw_handle, type_support
from support.nodes.ros import spin_until

if not IS_MANYCORE:
    pytest.skip("Fast DDS has some of it", allow_module_level=True)

OK, UNSUPPORTED = 0, 3
STRICTLY = 1  # RMW_UNIQUE_NETWORK_FLOW_ENDPOINTS_STRICTLY_REQUIRED
PUBLICATION_NUMBER, RECEPTION_NUMBER, TYPE_DISCOVERY, DYNAMIC_MESSAGES = range(4)

# Function, and the kind of entity whose handle is its first argument.
REFUSED = [
    ("rmw_publisher_get_network_flow_endpoints", "publisher"),
    ("rmw_subscription_get_network_flow_endpoints", "subscription"),
    ("rmw_subscription_set_content_filter", "subscription"),
    ("rmw_subscription_get_content_filter", "subscription"),
    ("rmw_take_dynamic_message", "subscription"),
    ("rmw_take_dynamic_message_with_info", "subscription"),
    ("rmw_init_publisher_allocation", None),
    ("rmw_fini_publisher_allocation", None),
    ("rmw_init_subscription_allocation", None),
    ("rmw_fini_subscription_allocation", None),
    ("rmw_get_serialized_message_size", None),
]

rcutils.rcutils_get_error_string.restype = type(
    "ErrorString", (ctypes.Structure,), {"_fields_": [("text", ctypes.c_char * 1024)]}
)


def zeros() -> Any:
    return ctypes.create_string_buffer(256)


@pytest.mark.parametrize(("function", "owner"), REFUSED, ids=[name for name, _ in REFUSED])
def test_refused_with_a_reason(node, function, owner):
    publisher = node.create_publisher(Point, "points", 10)
    subscription = node.create_subscription(Point, "points", print, 10)
    handles = {"publisher": publisher, "subscription": subscription}
    first = zeros() if owner is None else rmw_handle(owner, handles[owner])
    rest = [zeros() for _ in range(5)]
    assert getattr(rmw, function)(first, *rest) == UNSUPPORTED
    assert b"rmw_manycore" in rcutils.rcutils_get_error_string().text
    assert all(buffer.raw == bytes(256) for buffer in rest), "wrote something all the same"
    rcutils.rcutils_reset_error()


class Strings(ctypes.Structure):
    """rcutils_string_array_t without strings."""

    _fields_ = (("size", ctypes.c_size_t), ("data", ctypes.c_void_p), ("a", ctypes.c_void_p * 5))


class ContentFilter(ctypes.Structure):
    _fields_ = (("expression", ctypes.c_char_p), ("parameters", Strings))


class SubscriptionOptions(ctypes.Structure):
    _fields_ = (
        ("payload", ctypes.c_void_p),
        ("ignore_local", ctypes.c_bool),
        ("unique_flow", ctypes.c_int),
        ("filter", ctypes.POINTER(ContentFilter)),
    )


class SubscriptionHandle(ctypes.Structure):
    """rmw_subscription_t."""

    _fields_ = (
        ("identifier", ctypes.c_char_p),
        ("data", ctypes.c_void_p),
        ("topic", ctypes.c_char_p),
        ("options", SubscriptionOptions),
        ("can_loan_messages", ctypes.c_bool),
        ("is_cft_enabled", ctypes.c_bool),
    )


def create_subscription(node: Any, publisher: Any, options: SubscriptionOptions) -> Any:
    """Return a subscription of a publisher's topic and QoS, or a null pointer."""
    rcl.rcl_publisher_get_actual_qos.restype = ctypes.c_void_p
    qos = rcl.rcl_publisher_get_actual_qos(rcl_handle(publisher))
    rmw.rmw_create_subscription.restype = ctypes.POINTER(SubscriptionHandle)
    return rmw.rmw_create_subscription(
        rmw_handle("node", node),
        type_support(Point),
        b"/points",
        ctypes.c_void_p(qos),
        ctypes.byref(options),
    )


def test_network_flows_of_its_own_are_no_subscriptions_to_insist_on(node):
    publisher = node.create_publisher(Point, "points", 10)
    assert not create_subscription(node, publisher, SubscriptionOptions(unique_flow=STRICTLY))
    assert b"uses no network" in rcutils.rcutils_get_error_string().text
    rcutils.rcutils_reset_error()


def test_a_content_filter_is_not_enabled_and_everything_arrives(node):
    """rcl is told so, and filters in the callback."""
    publisher = node.create_publisher(Point, "points", 10)
    wanted = SubscriptionOptions(
        filter=ctypes.pointer(ContentFilter(expression=b"x > 100", parameters=Strings()))
    )
    subscription = create_subscription(node, publisher, wanted)
    assert subscription.contents.is_cft_enabled is False
    spin_until(node, lambda: publisher.get_subscription_count() == 1)
    publisher.publish(Point(x=1.0))
    point, taken = (ctypes.c_double * 3)(), ctypes.c_bool()
    assert rmw.rmw_take(subscription, point, ctypes.byref(taken), None) == OK
    assert (taken.value, list(point)) == (True, [1, 0, 0])
    assert rmw.rmw_destroy_subscription(rmw_handle("node", node), subscription) == OK


def test_features(node):
    rmw.rmw_feature_supported.restype = ctypes.c_bool
    supported = [f for f in range(8) if rmw.rmw_feature_supported(f)]
    assert supported == [PUBLICATION_NUMBER, RECEPTION_NUMBER]


def test_both_sequence_numbers_count_by_one(node):
    infos = []
    publisher = node.create_publisher(Point, "points", 10)
    node.create_subscription(Point, "points", lambda _, info: infos.append(info), 10)
    spin_until(node, publisher.get_subscription_count)
    for _ in range(3):
        publisher.publish(Point())
    spin_until(node, lambda: len(infos) == 3)
    for name in ("publication_sequence_number", "reception_sequence_number"):
        numbers = [info[name] for info in infos]
        assert numbers == [numbers[0], numbers[0] + 1, numbers[0] + 2], name
