# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""Waiting: guard conditions, timers, executors with and without threads."""

from __future__ import annotations

import os
import re
import threading
import time
from collections.abc import Iterator
from contextlib import ExitStack, contextmanager
from pathlib import Path

import pytest
import rclpy
from rclpy._rclpy_pybind11 import GuardCondition, RCLError, WaitSet
from rclpy.callback_groups import MutuallyExclusiveCallbackGroup, ReentrantCallbackGroup
from rclpy.event_handler import SubscriptionEventCallbacks
from rclpy.executors import Executor, MultiThreadedExecutor, SingleThreadedExecutor
from rclpy.node import Node
from rclpy.task import Future
from std_msgs.msg import String
from std_srvs.srv import Trigger

from support import IS_MANYCORE, TIMEOUT_S, wait_until
from support.nodes.ros import announce, peer_node, spin_until, spinning_thread

# The EventsExecutor does not wait: see test_executors.py and test_callbacks.py.
EXECUTORS = [SingleThreadedExecutor, MultiThreadedExecutor]


@contextmanager
def spinning(node: Node, executor: Executor) -> Iterator[None]:
    """Spin a node in a new thread."""
    executor.add_node(node)
    with spinning_thread(executor):
        yield
    executor.shutdown()


def test_guard_condition_wakes_a_spinning_thread(node):
    triggered = threading.Event()
    guard = node.create_guard_condition(triggered.set)
    with spinning(node, SingleThreadedExecutor()):
        for _ in range(100):  # some of them while the thread sleeps
            triggered.clear()
            guard.trigger()
            assert triggered.wait(TIMEOUT_S)


def status_of(thread: threading.Thread, key: str) -> str:
    """Return a line of /proc/self/task/TID/status."""
    status = Path(f"/proc/self/task/{thread.native_id}/status").read_text()
    found = re.search(rf"^{key}:\s+(.*)$", status, re.M)
    assert found
    return found.group(1)


def slept_times(thread: threading.Thread) -> int:
    return int(status_of(thread, "voluntary_ctxt_switches"))


def is_asleep(thread: threading.Thread) -> bool:
    """Return whether the thread waits in the middleware, not for the interpreter lock."""
    if not status_of(thread, "State").startswith("S"):
        return False
    slept = slept_times(thread)
    sleeping_s = 0.05  # Python requests the interpreter lock every 5 ms
    return not threading.Event().wait(sleeping_s) and slept_times(thread) == slept


@pytest.mark.skipif(not IS_MANYCORE, reason="other middlewares have threads of their own")
def test_a_message_wakes_only_the_thread_that_waits_for_it(node):
    """Nodes composed in a process, each with its executor thread, do not wake up each other."""
    names = [f"composed_{i}" for i in range(8)]
    heard: dict[str, int] = dict.fromkeys(names, 0)
    publishers = [node.create_publisher(String, name, 10) for name in names]

    def hear(name: str) -> None:
        heard[name] += 1

    with ExitStack() as stack:
        threads = []
        for name in names:
            composed = rclpy.create_node(name)
            stack.callback(composed.destroy_node)
            composed.create_subscription(String, name, lambda _, name=name: hear(name), 10)
            executor = SingleThreadedExecutor()
            executor.add_node(composed)
            threads.append(stack.enter_context(spinning_thread(executor)))
        for publisher in publishers:
            publisher.publish(String())
        wait_until(lambda: all(heard.values()), "all spin")
        wait_until(lambda: all(is_asleep(thread) for thread in threads), "all wait")
        before = [slept_times(thread) for thread in threads]
        for count in range(2, 20):
            publishers[0].publish(String())
            wait_until(lambda count=count: heard[names[0]] == count, "it is heard")
        assert slept_times(threads[0]) > before[0]
        assert [slept_times(thread) for thread in threads[1:]] == before[1:]


def test_a_trigger_before_the_wait_is_not_lost(node):
    triggered = []
    guard = node.create_guard_condition(lambda: triggered.append(1))
    guard.trigger()
    rclpy.spin_once(node, timeout_sec=30)
    assert triggered == [1]


def test_wait_times_out(node):
    """With nothing to do a wait lasts as long as requested, and no callback runs."""
    before = time.monotonic()
    rclpy.spin_once(node, timeout_sec=0.2)
    assert time.monotonic() - before >= 0.199


@pytest.mark.skipif(not IS_MANYCORE, reason="Fast DDS goes on waiting")
def test_a_wait_ends_with_its_context():
    """On SIGTERM rclpy shuts contexts down after it woke its executors, which may wait again."""
    context = rclpy.Context()
    context.init()
    with context.handle:
        never = GuardCondition(context.handle)
        wait_set = WaitSet(0, 1, 0, 0, 0, 0, context.handle)
    wait_set.clear_entities()
    wait_set.add_guard_condition(never)
    thread = threading.Thread(target=wait_set.wait, args=(-1,), daemon=True)
    thread.start()
    context.shutdown()
    thread.join(TIMEOUT_S)
    assert not thread.is_alive()


def test_timers(node):
    ticks = {0.01: 0, 0.03: 0}

    def count(period_s: float) -> None:
        ticks[period_s] += 1

    timers = [node.create_timer(period, lambda p=period: count(p)) for period in ticks]
    spin_until(node, lambda: ticks[0.01] > ticks[0.03] >= 5)
    timers[0].cancel()
    stopped_at, seen = ticks[0.01], ticks[0.03]
    spin_until(node, lambda: ticks[0.03] == seen + 5)
    assert ticks[0.01] == stopped_at


@pytest.mark.parametrize("executor_type", EXECUTORS)
def test_executors_deliver(node, start_peer, peer_cluster, executor_type):
    heard = threading.Semaphore(0)
    received = []

    def hear(message: String) -> None:
        received.append(int(message.data))
        heard.release()

    node.create_subscription(String, "numbers", hear, 100)
    with spinning(node, executor_type()):
        start_peer(publish_numbers, cluster=peer_cluster)
        assert all(heard.acquire(timeout=TIMEOUT_S) for _ in range(100))
    assert sorted(received) == list(range(100))


def publish_numbers() -> None:
    with peer_node() as node:
        publisher = node.create_publisher(String, "numbers", 100)
        spin_until(node, publisher.get_subscription_count)
        for number in range(100):
            publisher.publish(String(data=str(number)))
        rclpy.spin(node)


@pytest.mark.parametrize("executor_type", EXECUTORS)
def test_executors_serve(node, start_peer, executor_type):
    """Services, clients and timers in one executor."""

    def succeed(_, response):
        response.success = True
        return response

    node.create_service(Trigger, "trigger", succeed)
    with spinning(node, executor_type()):
        peer = start_peer(call_trigger, executor_type.__name__, cluster=2)
        peer.wait_for("10 answers")


def call_trigger(executor_name: str) -> None:
    executor = {kind.__name__: kind for kind in EXECUTORS}[executor_name]
    with peer_node() as node:
        client = node.create_client(Trigger, "trigger")
        assert client.wait_for_service(TIMEOUT_S)
        answers = []

        def count(answer: Future) -> None:
            answers.append(answer)
            if len(answers) >= 10:
                announce("10 answers")

        node.create_timer(
            0.01, lambda: client.call_async(Trigger.Request()).add_done_callback(count)
        )
        rclpy.spin(node, executor())


def test_call_within_a_callback(node, start_peer):
    """A callback waits for a service while other threads of its executor continue.

    The timer's calls come one after the other: as many at once as there are threads would leave
    no thread for the responses. No request is pending after the last call.
    """
    start_peer(answer_trigger, cluster=2)
    client = node.create_client(Trigger, "trigger", callback_group=ReentrantCallbackGroup())
    assert client.wait_for_service(TIMEOUT_S)
    answers, done = [], threading.Event()

    def call() -> None:
        answers.append(client.call(Trigger.Request()).message)
        if len(answers) == 20:
            timer.cancel()
            done.set()

    timer = node.create_timer(0.01, call, callback_group=MutuallyExclusiveCallbackGroup())
    with spinning(node, MultiThreadedExecutor(4)):
        assert done.wait(TIMEOUT_S)
    assert answers == ["here"] * 20


def answer_trigger() -> None:
    with peer_node() as node:

        def answer(_, response):
            response.message = "here"
            return response

        node.create_service(Trigger, "trigger", answer)
        rclpy.spin(node)


def test_many_entities_in_one_wait(node):
    """Each of a hundred subscriptions wakes up for its own messages only."""
    heard = {}
    publishers = []
    for number in range(100):
        topic = f"topic_{number}"
        publishers.append(node.create_publisher(String, topic, 1))
        node.create_subscription(String, topic, lambda m, t=topic: heard.update({t: m.data}), 1)
    spin_until(node, lambda: all(p.get_subscription_count() for p in publishers))
    for number, publisher in enumerate(publishers):
        publisher.publish(String(data=str(number)))
    spin_until(node, lambda: len(heard) == 100)
    assert heard == {f"topic_{number}": str(number) for number in range(100)}


def test_init_and_shutdown_again_and_again():
    for number in range(5):
        rclpy.init()
        node = rclpy.create_node(f"node_{number}")
        received = []
        publisher = node.create_publisher(String, "chatter", 1)
        node.create_subscription(String, "chatter", received.append, 1)
        spin_until(node, publisher.get_subscription_count)
        publisher.publish(String())
        spin_until(node, lambda received=received: received)
        node.destroy_node()
        rclpy.shutdown()


def test_shutdown_with_everything_still_there():
    """Endpoints that are still referenced when the context ends do no harm."""
    rclpy.init()
    node = rclpy.create_node("tester")
    publisher = node.create_publisher(String, "chatter", 1)
    subscription = node.create_subscription(String, "chatter", lambda _: None, 1)
    client = node.create_client(Trigger, "trigger")
    rclpy.shutdown()
    with pytest.raises(RCLError, match="context is invalid"):
        publisher.publish(String())
    for entity in (publisher, subscription, client):
        entity.destroy()
    node.destroy_node()


def test_a_node_of_another_domain_wakes_an_executor(domains, start_peer, monkeypatch):
    """One executor spins nodes of two domains, as a bridge between them does."""
    monkeypatch.delenv("MANYCORE_PLATFORM", raising=False)
    rclpy.init(domain_id=domains[0])
    foreign = rclpy.Context()
    rclpy.init(context=foreign, domain_id=domains[1])
    own_node = rclpy.create_node("own")
    foreign_node = rclpy.create_node("foreign", context=foreign)
    messages, requests, matches = (threading.Semaphore(0) for _ in range(3))

    def answer(_, response):
        requests.release()
        return response

    events = SubscriptionEventCallbacks(matched=lambda _: matches.release())
    foreign_node.create_subscription(
        String, "numbers", lambda _: messages.release(), 10, event_callbacks=events
    )
    foreign_node.create_service(Trigger, "trigger", answer)
    executor = SingleThreadedExecutor()
    executor.add_node(foreign_node)
    with spinning(own_node, executor):
        start_peer(talk_and_ask, domains[1])
        for happened in (matches, *[messages] * 3, *[requests] * 3):
            assert happened.acquire(timeout=TIMEOUT_S)
    own_node.destroy_node()
    foreign_node.destroy_node()
    rclpy.shutdown(context=foreign)
    rclpy.shutdown()


def talk_and_ask(domain: int) -> None:
    """Slowly, so that the other side sleeps in between."""
    os.environ.pop("MANYCORE_PLATFORM", None)
    os.environ["ROS_DOMAIN_ID"] = str(domain)
    with peer_node() as node:
        publisher = node.create_publisher(String, "numbers", 10)
        client = node.create_client(Trigger, "trigger")
        node.create_timer(0.05, lambda: publisher.publish(String()))
        node.create_timer(0.05, lambda: client.call_async(Trigger.Request()))
        rclpy.spin(node)
