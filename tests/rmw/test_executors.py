# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""All executors of rclpy: single-threaded, multi-threaded and EventsExecutor."""

from __future__ import annotations

import threading
import time
from collections.abc import Callable, Iterator
from typing import Any

import pytest
import rclpy
from rclpy._rclpy_pybind11 import RCLError
from rclpy.action import ActionClient, ActionServer
from rclpy.callback_groups import MutuallyExclusiveCallbackGroup, ReentrantCallbackGroup
from rclpy.event_handler import PublisherEventCallbacks, SubscriptionEventCallbacks
from rclpy.executors import ExternalShutdownException, MultiThreadedExecutor, SingleThreadedExecutor
from rclpy.experimental import EventsExecutor
from rclpy.node import Node
from std_msgs.msg import String
from std_srvs.srv import Trigger
from test_msgs.action import Fibonacci

from support import TIMEOUT_S
from support.nodes.ros import announce, peer_node, spinning_thread

THREADS = 4
EXECUTORS = {
    "single": SingleThreadedExecutor,
    "multi": lambda: MultiThreadedExecutor(num_threads=THREADS),
    "events": EventsExecutor,
}


# The EventsExecutor has no guard conditions, learns of new entities only between its turns, and
# does not end with its context, whatever the middleware.
waiting_executors = pytest.mark.parametrize("executor", ["single", "multi"], indirect=True)


@pytest.fixture(params=EXECUTORS)
def executor(request: pytest.FixtureRequest, node: Node) -> Iterator[Any]:
    """Yield an executor with the test's node."""
    executor = EXECUTORS[request.param]()
    executor.add_node(node)
    yield executor
    executor.shutdown()


@pytest.fixture
def spinning(executor: Any) -> Iterator[None]:
    """Spin the executor in a new thread."""
    with spinning_thread(executor):
        yield


def run_until(executor: Any, condition: Callable[[], Any]) -> None:
    deadline = time.monotonic() + TIMEOUT_S
    while not condition():
        assert time.monotonic() < deadline, f"not within {TIMEOUT_S:g} s"
        executor.spin_once(0.05)


def result_of(executor: Any, future: Any) -> Any:
    run_until(executor, future.done)
    return future.result()


def answer() -> None:
    """Serve a topic, a service and an action."""
    with peer_node() as node:
        pongs = node.create_publisher(String, "pong", 10)
        node.create_subscription(String, "ping", pongs.publish, 10)
        node.create_service(Trigger, "ask", lambda _, reply: _said("from the peer", reply))
        ActionServer(node, Fibonacci, "fibonacci", _compute)
        announce("ready")
        rclpy.spin(node)


def _said(text: str, reply: Trigger.Response) -> Trigger.Response:
    reply.success, reply.message = True, text
    return reply


def _compute(goal: Any) -> Fibonacci.Result:
    goal.publish_feedback(Fibonacci.Feedback(sequence=[0, 1]))
    goal.succeed()
    return Fibonacci.Result(sequence=[0, 1, 1])


@pytest.fixture
def peer(start_peer: Any, peer_cluster: int) -> None:
    start_peer(answer, cluster=peer_cluster).wait_for("ready")


def test_topics_services_and_actions(node: Node, executor: Any, peer: None) -> None:
    received: list[Any] = []
    node.create_subscription(String, "pong", received.append, 10)
    pings = node.create_publisher(String, "ping", 10)
    run_until(executor, lambda: pings.get_subscription_count() and node.count_publishers("pong"))
    for number in range(1, 21):
        pings.publish(String(data=str(number)))
        run_until(executor, lambda n=number: len(received) == n)
    assert [message.data for message in received] == [str(number) for number in range(1, 21)]

    client = node.create_client(Trigger, "ask")
    run_until(executor, client.service_is_ready)
    for _ in range(5):
        answered = result_of(executor, client.call_async(Trigger.Request()))
        assert answered.message == "from the peer"

    feedback: list[Any] = []
    actions = ActionClient(node, Fibonacci, "fibonacci")
    run_until(executor, actions.server_is_ready)
    goal = result_of(executor, actions.send_goal_async(Fibonacci.Goal(order=2), feedback.append))
    run_until(executor, lambda: feedback)  # before the result, which ends feedback
    result = result_of(executor, goal.get_result_async()).result
    assert list(result.sequence) == [0, 1, 1]


def test_a_node_serves_itself(node: Node, executor: Any) -> None:
    node.create_service(Trigger, "ask", lambda _, reply: _said("from myself", reply))
    ActionServer(node, Fibonacci, "fibonacci", _compute)
    client = node.create_client(Trigger, "ask")
    actions = ActionClient(node, Fibonacci, "fibonacci")
    assert result_of(executor, client.call_async(Trigger.Request())).message == "from myself"
    goal = result_of(executor, actions.send_goal_async(Fibonacci.Goal(order=2)))
    assert list(result_of(executor, goal.get_result_async()).result.sequence) == [0, 1, 1]


def test_timers(node: Node, executor: Any) -> None:
    ticks: list[int] = []
    others: list[int] = []
    node.create_timer(0.01, lambda: ticks.append(0))
    node.create_timer(0.02, lambda: others.append(0))
    run_until(executor, lambda: len(ticks) >= 10 and len(others) >= 5)


@waiting_executors
def test_guard_conditions(node: Node, executor: Any) -> None:
    triggers: list[int] = []
    guard = node.create_guard_condition(lambda: triggers.append(0))
    for _ in range(5):
        seen = len(triggers)
        guard.trigger()
        run_until(executor, lambda s=seen: len(triggers) > s)


@waiting_executors
def test_a_guard_condition_wakes_a_spinning_thread(node: Node, executor: Any, spinning) -> None:
    triggered = threading.Event()
    guard = node.create_guard_condition(triggered.set)
    for _ in range(20):
        guard.trigger()
        assert triggered.wait(TIMEOUT_S)
        triggered.clear()


@waiting_executors
def test_entities_are_made_and_destroyed_while_it_spins(node: Node, spinning) -> None:
    """Without event callbacks: rclpy may add an event to its wait set that was just destroyed."""
    without = {
        "subscription": SubscriptionEventCallbacks(use_default_callbacks=False),
        "publisher": PublisherEventCallbacks(use_default_callbacks=False),
    }
    for number in range(5):
        heard = threading.Event()
        topic = f"topic_{number}"
        subscription = node.create_subscription(
            String,
            topic,
            lambda _, e=heard: e.set(),
            10,
            event_callbacks=without["subscription"],
        )
        publisher = node.create_publisher(String, topic, 10, event_callbacks=without["publisher"])
        publisher.publish(String())
        assert heard.wait(TIMEOUT_S)
        node.destroy_subscription(subscription)
        node.destroy_publisher(publisher)


def spin_until_the_context_ends(executor: Any) -> None:
    """Spin; rclpy raises at the end of a context, unless it is about to wait."""
    try:
        executor.spin()
    except ExternalShutdownException:
        pass
    except RCLError as error:
        if "context is not valid" not in str(error):
            raise


@waiting_executors
def test_the_end_of_the_context_ends_spinning(node: Node, executor: Any) -> None:
    is_spinning = threading.Event()
    node.create_timer(0.01, is_spinning.set)
    thread = threading.Thread(target=spin_until_the_context_ends, args=(executor,))
    thread.start()
    assert is_spinning.wait(TIMEOUT_S)
    rclpy.shutdown()
    thread.join(TIMEOUT_S)
    assert not thread.is_alive()
    rclpy.init()  # for the fixture, which shuts down again


@pytest.fixture
def many_threads(node: Node) -> Iterator[MultiThreadedExecutor]:
    executor = MultiThreadedExecutor(num_threads=THREADS)
    executor.add_node(node)
    yield executor
    executor.shutdown()


def test_callbacks_run_side_by_side(node: Node, many_threads: MultiThreadedExecutor) -> None:
    """Each callback waits for all others: one after the other, none could end."""
    together = threading.Barrier(THREADS, timeout=TIMEOUT_S)
    met: list[int] = []

    def meet(_: String) -> None:
        together.wait()
        met.append(0)

    for number in range(THREADS):
        group = MutuallyExclusiveCallbackGroup()
        node.create_subscription(String, f"topic_{number}", meet, 10, callback_group=group)
        node.create_publisher(String, f"topic_{number}", 10).publish(String())
    run_until(many_threads, lambda: len(met) == THREADS)


def test_a_callback_waits_for_a_service(
    node: Node, many_threads: MultiThreadedExecutor, peer: None
) -> None:
    """Blocking calls are allowed where another thread takes the response."""
    group = ReentrantCallbackGroup()
    client = node.create_client(Trigger, "ask", callback_group=group)
    answers: list[str] = []

    def ask(_: String) -> None:
        assert client.wait_for_service(TIMEOUT_S)
        answers.append(client.call(Trigger.Request()).message)

    node.create_subscription(String, "go", ask, 10, callback_group=group)
    publisher = node.create_publisher(String, "go", 10)
    for _ in range(3):
        publisher.publish(String())
    run_until(many_threads, lambda: len(answers) == 3)
    assert set(answers) == {"from the peer"}
