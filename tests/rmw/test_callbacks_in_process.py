# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""Callbacks for messages of the same process, which the publishing thread calls.

In C on the handles of rclpy, which sets callbacks only for its executor.
"""

from __future__ import annotations

import ctypes
import threading
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from typing import Any

import pytest
import rclpy
from rclpy.node import Node
from rclpy.qos import HistoryPolicy, QoSProfile
from std_msgs.msg import String
from std_srvs.srv import Trigger

from support import IS_MANYCORE, TIMEOUT_S, wait_until
from support.nodes.handles import rcl, rcl_handle

pytestmark = pytest.mark.skipif(not IS_MANYCORE, reason="Fast DDS calls from other threads, too")

DEEP = 1000
QUEUE = 1024  # hints that the queue of a subscription holds that keeps all

_Function = ctypes.CFUNCTYPE(None, ctypes.c_void_p, ctypes.c_size_t)


class Arrivals:
    """What the callback of an entity was told, and by which threads; it calls `then`."""

    def __init__(
        self,
        entity: Any,
        setter: str = "rcl_subscription_set_on_new_message_callback",
        then: Callable[[], Any] = int,
    ) -> None:
        self.count = 0
        self.threads: list[int] = []
        self._then = then
        self._function = _Function(self._called)
        self._handle = rcl_handle(entity)
        self._setter = getattr(rcl, setter)
        self._set(self._function)
        self._is_set = True

    def _called(self, _: Any, count: int) -> None:
        self.count += count
        self.threads.append(threading.get_ident())
        self._then()

    def _set(self, function: Any) -> None:
        assert self._setter(self._handle, function, None) == 0

    def clear(self) -> None:
        if self._is_set:
            self._is_set = False
            self._set(None)


@pytest.fixture
def arrivals_of() -> Iterator[Callable[..., Arrivals]]:
    """Return a function that makes Arrivals, and clear them before the node is destroyed.

    rclpy destroys with the lock of the interpreter, for which a callback may be waiting.
    """
    made: list[Arrivals] = []

    def make(*arguments: Any, **options: Any) -> Arrivals:
        made.append(Arrivals(*arguments, **options))
        return made[-1]

    yield make
    for arrivals in made:
        arrivals.clear()


@contextmanager
def other_node(name: str) -> Iterator[Node]:
    """Yield a node of a context of its own."""
    context = rclpy.Context()
    rclpy.init(context=context)
    node = rclpy.create_node(name, context=context)
    yield node
    node.destroy_node()
    rclpy.shutdown(context=context)


def listen(node: Node, depth: int = DEEP) -> Any:
    return node.create_subscription(String, "chatter", print, depth)


def speak(node: Node, depth: int = DEEP) -> Any:
    return node.create_publisher(String, "chatter", depth)


def is_called_by_this_thread(arrivals: Arrivals, publisher: Any) -> bool:
    """Return whether a message is reported by the thread that publishes, sooner or later.

    The callback thread does it where it is looking just then.
    """
    for published in range(arrivals.count + 1, DEEP):
        publisher.publish(String())
        wait_until(lambda count=published: arrivals.count == count, "it is reported")
        if arrivals.threads[-1] == threading.get_ident():
            return True
    return False


def test_the_thread_that_publishes_calls(node, arrivals_of):
    arrivals = arrivals_of(listen(node))
    publisher = speak(node)
    assert is_called_by_this_thread(arrivals, publisher)
    arrivals.clear()
    before = arrivals.count
    publisher.publish(String())
    assert arrivals.count == before


def test_a_callback_that_publishes_is_called_for_that_too_but_not_inside_itself(node, arrivals_of):
    publisher = speak(node)
    depth, depths, done = 0, [], threading.Event()

    def publish_again() -> None:
        nonlocal depth
        depth += 1
        depths.append(depth)
        if arrivals.count < 100:
            publisher.publish(String())
        else:
            done.set()
        depth -= 1

    arrivals = arrivals_of(listen(node), then=publish_again)
    publisher.publish(String())
    assert done.wait(TIMEOUT_S)
    arrivals.clear()
    assert set(depths) == {1}


def test_publishing_does_not_wait_for_a_callback_that_runs(node, arrivals_of):
    """Such a callback may wait for a lock that the publishing thread holds."""
    entered, released, both = threading.Event(), threading.Event(), threading.Event()

    def hold() -> None:
        entered.set()
        assert released.wait(TIMEOUT_S)
        if arrivals.count == 2:
            both.set()

    arrivals = arrivals_of(listen(node), then=hold)
    threads = [
        threading.Thread(target=speak(node).publish, args=(String(),), daemon=True)
        for _ in range(2)
    ]
    threads[0].start()
    assert entered.wait(TIMEOUT_S)
    threads[1].start()
    threads[1].join(TIMEOUT_S)
    assert not threads[1].is_alive(), "publish waits for the callback"
    released.set()
    threads[0].join()
    assert both.wait(TIMEOUT_S)


def test_other_entities_come_and_go_while_a_callback_runs(node, arrivals_of):
    """Such a callback may wait for a lock that the thread that sets or destroys holds."""
    entered, released, in_time = threading.Event(), threading.Event(), []

    def hold() -> None:
        entered.set()
        in_time.append(released.wait(TIMEOUT_S))

    arrivals_of(listen(node), then=hold)
    threading.Thread(target=speak(node).publish, args=(String(),), daemon=True).start()
    assert entered.wait(TIMEOUT_S)
    other = node.create_subscription(String, "other", print, DEEP)
    node.create_publisher(String, "other", DEEP).publish(String())
    told = Arrivals(other)
    node.destroy_subscription(node.create_subscription(String, "another", print, DEEP))
    released.set()
    wait_until(lambda: in_time, "the callback ends")
    assert in_time == [True]
    wait_until(lambda: told.count == 1, "the message from before the callback was set is reported")
    told.clear()


def test_callbacks_that_clear_each_other_do_not_meet(node, arrivals_of):
    """One has an earlier message to report when it is set, while the other one runs."""
    entered, is_set, in_time = threading.Event(), threading.Event(), []
    told: list[Arrivals] = []

    def clear_the_other() -> None:
        entered.set()
        in_time.append(is_set.wait(TIMEOUT_S))
        told[0].clear()

    runs = arrivals_of(listen(node), then=clear_the_other)
    other = node.create_subscription(String, "other", print, DEEP)
    node.create_publisher(String, "other", DEEP).publish(String())
    threading.Thread(target=speak(node).publish, args=(String(),), daemon=True).start()
    assert entered.wait(TIMEOUT_S)
    told.append(Arrivals(other, then=runs.clear))
    is_set.set()
    wait_until(lambda: in_time, "the callback ends")
    assert in_time == [True]


def test_messages_of_many_threads_are_all_reported_once(node, arrivals_of):
    arrivals = arrivals_of(listen(node))
    publishers = [speak(node) for _ in range(4)]

    def publish(publisher: Any) -> None:
        for _ in range(DEEP // 4):
            publisher.publish(String())

    threads = [threading.Thread(target=publish, args=(publisher,)) for publisher in publishers]
    for thread in threads:
        thread.start()
    for thread in threads:
        thread.join()
    wait_until(lambda: arrivals.count >= DEEP, "all are reported")
    arrivals.clear()
    assert arrivals.count == DEEP


def test_a_callback_clears_itself_and_destroys_others_of_its_topic(node, arrivals_of):
    """The one that is destroyed may be next in turn, or told before."""
    subscriptions = [listen(node) for _ in range(3)]
    arrivals: list[Arrivals] = []

    def destroy_others() -> None:
        for arrival in arrivals:
            arrival.clear()
        while subscriptions:
            node.destroy_subscription(subscriptions.pop())

    arrivals += [arrivals_of(subscription, then=destroy_others) for subscription in subscriptions]
    publisher = speak(node)
    publisher.publish(String())
    publisher.publish(String())
    assert sum(arrival.count for arrival in arrivals) == 1


def test_a_callback_that_gets_earlier_messages_may_clear_itself(node):
    subscription = listen(node)
    publisher = speak(node)
    publisher.publish(String())
    calls = []

    def called(_: Any, count: int) -> None:
        calls.append(count)
        set_callback(rcl_handle(subscription), None, None)

    set_callback = rcl.rcl_subscription_set_on_new_message_callback
    function = _Function(called)
    assert set_callback(rcl_handle(subscription), function, None) == 0
    assert calls == [1]
    publisher.publish(String())
    assert calls == [1]


def test_what_only_a_look_at_all_publishers_finds_is_reported(node, arrivals_of):
    """A full queue that keeps all has no room for a hint. The look is left to the thread."""
    keep_all = QoSProfile(history=HistoryPolicy.KEEP_ALL, depth=1)
    arrivals = arrivals_of(node.create_subscription(String, "chatter", print, keep_all))
    publisher = speak(node, depth=2 * QUEUE)
    for _ in range(QUEUE + 100):
        publisher.publish(String())
    wait_until(lambda: arrivals.count >= QUEUE + 100, "all are reported")


def test_contexts_of_one_process_call_for_each_other(node, arrivals_of):
    """They are one process to the platform, and each has a thread of its own."""
    seen = [threading.Event(), threading.Event()]
    with other_node("other") as other:
        arrivals = [
            arrivals_of(listen(owner), then=event.set)
            for owner, event in zip((node, other), seen, strict=True)
        ]
        for publishing in (node, other):
            publisher = speak(publishing)
            for event in seen:
                event.clear()
            publisher.publish(String())
            for event in seen:
                assert event.wait(TIMEOUT_S)
        for arrival in arrivals:
            arrival.clear()


def test_a_context_calls_itself_once_the_one_before_it_has_ended(platform, arrivals_of):
    for _ in range(2):
        with other_node("one_of_two") as node:
            arrivals = arrivals_of(listen(node))
            assert is_called_by_this_thread(arrivals, speak(node))
            arrivals.clear()


@pytest.mark.parametrize("role", ["service", "client"])
def test_the_thread_that_asks_or_answers_calls(node, arrivals_of, role: str):
    service = node.create_service(Trigger, "ready", lambda _, answer: answer)
    client = node.create_client(Trigger, "ready")
    kind, entity = ("request", service) if role == "service" else ("response", client)
    arrivals = arrivals_of(entity, f"rcl_{role}_set_on_new_{kind}_callback")
    for published in range(1, DEEP):
        client.call_async(Trigger.Request())
        with service.handle:
            _, header = service.handle.service_take_request(Trigger.Request)
            service.handle.service_send_response(Trigger.Response(), header.request_id)
        wait_until(lambda count=published: arrivals.count == count, "it is reported")
        if arrivals.threads[-1] == threading.get_ident():
            break
    assert arrivals.threads[-1] == threading.get_ident()


@pytest.mark.parametrize("is_own", [True, False], ids=["own message", "message of another context"])
def test_a_callback_may_shut_its_context_down(node, arrivals_of, is_own):
    """In the publishing thread and in the thread for callbacks."""
    context = rclpy.Context()
    rclpy.init(context=context)
    listener = rclpy.create_node("listener", context=context)
    done = threading.Event()

    def shut_down() -> None:
        context.shutdown()
        done.set()

    arrivals = arrivals_of(listen(listener), then=shut_down)
    publisher = speak(listener if is_own else node)
    wait_until(lambda: publisher.get_subscription_count() == 1, "a match")
    publisher.publish(String())
    assert done.wait(TIMEOUT_S)
    assert not context.ok()
    assert arrivals.count == 1
    arrivals.clear()
    listener.destroy_node()
