# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""Callbacks for arrivals, through the EventsExecutor, which uses them instead of wait sets."""

from __future__ import annotations

import ctypes
import sys
import threading
import time
from collections.abc import Callable, Iterator
from functools import partial
from itertools import islice
from pathlib import Path
from typing import Any

import pytest
import rclpy
from rclpy.duration import Duration
from rclpy.event_handler import SubscriptionEventCallbacks
from rclpy.experimental import EventsExecutor
from rclpy.qos import QoSProfile
from std_msgs.msg import String
from std_srvs.srv import Trigger

from support import RMW, TIMEOUT_S
from support.nodes.ros import announce, peer_node

DEADLINE_MISSED, PUBLISHER_MATCHED = 0, 4  # of rcl_publisher_event_type_t


@pytest.fixture
def executor(node) -> Iterator[EventsExecutor]:
    executor = EventsExecutor()
    executor.add_node(node)
    yield executor
    executor.shutdown()


def run_until(executor: EventsExecutor, condition: Callable[[], Any]) -> None:
    deadline = time.monotonic() + TIMEOUT_S
    while not condition():
        assert time.monotonic() < deadline, f"not within {TIMEOUT_S:g} s"
        executor.spin_once(0.05)


def talk() -> None:
    with peer_node() as node:
        publisher = node.create_publisher(String, "chatter", 10)
        numbers = iter(range(1_000_000))
        node.create_timer(0.005, lambda: publisher.publish(String(data=str(next(numbers)))))
        rclpy.spin(node)


def count_to(limit: int) -> None:
    """Publish numbers one by one, all of which fit into the queue of a late reader."""
    with peer_node() as node:
        publisher = node.create_publisher(String, "numbers", limit)
        while not publisher.get_subscription_count():
            rclpy.spin_once(node, timeout_sec=0.05)
        numbers = iter(range(limit))
        node.create_timer(
            0.005, lambda: [publisher.publish(String(data=str(n))) for n in islice(numbers, 1)]
        )
        rclpy.spin(node)


def test_messages(node, executor, start_peer, peer_cluster):
    received = []
    node.create_subscription(String, "numbers", lambda m: received.append(int(m.data)), 50)
    start_peer(count_to, 50, cluster=peer_cluster)
    run_until(executor, lambda: len(received) == 50)
    assert received == list(range(50))


def tell_each(count: int) -> None:
    """Publish one message on each of many topics, in another order than they were created in."""
    with peer_node() as node:
        publishers = [node.create_publisher(String, f"number_{n}", 1) for n in range(count)]
        while not all(publisher.get_subscription_count() for publisher in publishers):
            rclpy.spin_once(node, timeout_sec=0.05)
        for n in sorted(range(count), key=lambda n: n * 7 % count):
            publishers[n].publish(String(data=str(n)))
        rclpy.spin(node)


@pytest.mark.skipif(RMW != "rmw_manycore", reason="Fast DDS takes long to match so many")
def test_each_of_many_subscriptions_hears_of_its_message(node, executor, start_peer, peer_cluster):
    """There are more of them than marks that say which the thread has to look at."""
    received = {}
    for n in range(300):
        hear = partial(received.__setitem__, n)
        node.create_subscription(String, f"number_{n}", hear, 1)
    start_peer(tell_each, 300, cluster=peer_cluster)
    run_until(executor, lambda: len(received) == 300)
    assert {n: message.data for n, message in received.items()} == {n: str(n) for n in range(300)}


def test_messages_from_before_the_callback_was_set(node):
    received = []
    node.create_subscription(String, "chatter", received.append, 10)
    publisher = node.create_publisher(String, "chatter", 10)
    for number in range(3):
        publisher.publish(String(data=str(number)))
    executor = EventsExecutor()
    executor.add_node(node)
    run_until(executor, lambda: len(received) == 3)
    executor.shutdown()


def serve() -> None:
    with peer_node() as node:
        node.create_service(Trigger, "ready", lambda _, answer: answer)
        rclpy.spin(node)


def test_answers(node, executor, start_peer, peer_cluster):
    client = node.create_client(Trigger, "ready")
    start_peer(serve, cluster=peer_cluster)
    assert client.wait_for_service(TIMEOUT_S)
    future = client.call_async(Trigger.Request())
    run_until(executor, future.done)
    assert future.result() == Trigger.Response()


def ask() -> None:
    with peer_node() as node:
        client = node.create_client(Trigger, "ready")
        client.wait_for_service(TIMEOUT_S)
        rclpy.spin_until_future_complete(node, client.call_async(Trigger.Request()))
        announce("answered")


def test_requests(node, executor, start_peer, peer_cluster):
    node.create_service(Trigger, "ready", lambda _, answer: answer)
    peer = start_peer(ask, cluster=peer_cluster)
    run_until(executor, lambda: "answered" in peer.lines)


def test_events(node, start_peer, peer_cluster):
    matched = []
    node.create_subscription(
        String,
        "chatter",
        lambda _: None,
        10,
        event_callbacks=SubscriptionEventCallbacks(matched=matched.append),
    )
    executor = EventsExecutor()
    executor.add_node(node)
    peer = start_peer(talk, cluster=peer_cluster)
    run_until(executor, lambda: matched and matched[-1].current_count == 1)
    peer.stop()
    run_until(executor, lambda: matched[-1].current_count == 0)
    executor.shutdown()


def test_entities_that_go_while_messages_arrive(node, executor, start_peer, peer_cluster):
    """No callback runs for a destroyed subscription."""
    start_peer(talk, cluster=peer_cluster)
    for _ in range(20):
        received: list[String] = []
        subscription = node.create_subscription(String, "chatter", received.append, 10)
        run_until(executor, lambda got=received: got)
        node.destroy_subscription(subscription)


class EventsToWaitFor(ctypes.Structure):
    """rmw_events_t with one event."""

    _fields_ = (("count", ctypes.c_size_t), ("events", ctypes.POINTER(ctypes.c_void_p)))


def library(name: str, *functions: str) -> ctypes.CDLL:
    """Return a C library, some functions of which return pointers."""
    found = ctypes.CDLL(str(Path(sys.prefix, "lib", name)))
    for function in functions:
        getattr(found, function).restype = ctypes.c_void_p
    return found


EventCallback = ctypes.CFUNCTYPE(None, ctypes.c_void_p, ctypes.c_size_t)


def finish(rcl: ctypes.CDLL, event: ctypes.c_void_p) -> None:
    """Clear the callback, too: the deadline would call it after it has been destroyed."""
    assert rcl.rcl_event_set_callback(ctypes.byref(event), None, None) == 0
    assert rcl.rcl_event_fini(ctypes.byref(event)) == 0


def test_a_deadline_ends_a_sleep_that_began_before_its_callback_was_set(node):
    """In C as well: an executor sets all callbacks at once."""
    rcl = library("librcl.so")
    other = node.create_publisher(String, "other", 10)
    publisher = node.create_publisher(
        String, "chatter", QoSProfile(depth=10, deadline=Duration(seconds=0.3))
    )
    publisher.publish(String())  # its clock runs
    matched, missed = threading.Event(), threading.Event()
    callbacks = [EventCallback(lambda *_, seen=seen: seen.set()) for seen in (matched, missed)]
    events = [ctypes.c_void_p(), ctypes.c_void_p()]
    kinds = (other, PUBLISHER_MATCHED), (publisher, DEADLINE_MISSED)
    for event, (entity, kind) in zip(events, kinds, strict=True):
        handle = ctypes.c_void_p(entity.handle.pointer)
        assert rcl.rcl_publisher_event_init(ctypes.byref(event), handle, kind) == 0
    assert rcl.rcl_event_set_callback(ctypes.byref(events[0]), callbacks[0], None) == 0
    node.create_subscription(String, "other", print, 10)
    assert matched.wait(TIMEOUT_S)  # from here on the thread sleeps without a timeout
    assert rcl.rcl_event_set_callback(ctypes.byref(events[1]), callbacks[1], None) == 0
    assert missed.wait(TIMEOUT_S)
    for event in events:
        finish(rcl, event)


def test_the_callback_of_an_event_is_called_before_a_wait_ends(node):
    """In C on the handles of rclpy, which offers either callbacks or waits."""
    rcl = library("librcl.so", "rcl_publisher_get_context", "rcl_context_get_rmw_context")
    rcl.rcl_event_get_rmw_handle.restype = ctypes.c_void_p
    rmw = library(f"lib{RMW}.so", "rmw_create_wait_set")
    publisher = node.create_publisher(String, "chatter", 10)
    handle = ctypes.c_void_p(publisher.handle.pointer)
    context = ctypes.c_void_p(rcl.rcl_publisher_get_context(handle))
    rmw_context = ctypes.c_void_p(rcl.rcl_context_get_rmw_context(context))
    wait_set = ctypes.c_void_p(rmw.rmw_create_wait_set(rmw_context, ctypes.c_size_t(1)))

    calls = []
    began = threading.Event()

    def call_slowly(_: object, count: int) -> None:
        began.set()
        time.sleep(0.005)  # lets a wait that does not await the call end before it is counted
        calls.append(count)

    callback = EventCallback(call_slowly)
    event = ctypes.c_void_p()  # rcl_event_t holds one pointer
    assert rcl.rcl_publisher_event_init(ctypes.byref(event), handle, PUBLISHER_MATCHED) == 0
    assert rcl.rcl_event_set_callback(ctypes.byref(event), callback, None) == 0
    rmw_event = rcl.rcl_event_get_rmw_handle(ctypes.byref(event))
    status = (ctypes.c_size_t * 4)()
    for round_number in range(1, 21):
        began.clear()
        node.create_subscription(String, "chatter", print, 10)
        assert began.wait(TIMEOUT_S)
        waited = EventsToWaitFor(1, (ctypes.c_void_p * 1)(rmw_event))
        assert rmw.rmw_wait(None, None, None, None, ctypes.byref(waited), wait_set, None) == 0
        assert sum(calls) == round_number
        assert rcl.rcl_take_event(ctypes.byref(event), status) == 0
    finish(rcl, event)
    assert rmw.rmw_destroy_wait_set(wait_set) == 0
