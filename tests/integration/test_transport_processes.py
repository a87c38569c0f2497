# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""Arrays without ROS between processes: interrupted, killed, forked, and beside ROS nodes."""

from __future__ import annotations

import os
import signal
import sys
from collections.abc import Iterator
from contextlib import contextmanager
from typing import Any

import numpy as np
import pytest

import rmw_manycore_py as manycore
from rmw_manycore_py import transport
from rmw_manycore_py.native import _transport
from support import TIMEOUT_S, wait_until
from support.nodes.ros import announce, peer_node, spin_until
from support.processes.commands import peer_command
from support.processes.inspection import cpu_time_s, is_asleep, is_stopped, times_run

pytestmark = pytest.mark.integration


def take_until_interrupted() -> None:
    with transport.join() as member:
        subscription = member.subscription("/t", np.int32)
        try:
            announce("waits")
            subscription.take()
        except KeyboardInterrupt:
            announce("interrupted")


@pytest.mark.parametrize("wait", ["block", "adaptive", "spin"])
def test_ctrl_c_ends_a_take(start, platform: str, wait: str) -> None:
    peer = start(peer_command(take_until_interrupted), MANYCORE_WAIT=wait)
    peer.wait_for("^waits$")
    if wait == "spin":
        # It yields its CPU to others, so beside them it runs often, but uses little time.
        used_s, ran = cpu_time_s(peer.pid), times_run(peer.pid)
        wait_until(
            lambda: cpu_time_s(peer.pid) > used_s + 0.1 or times_run(peer.pid) > ran + 10,
            "it spins",
        )
    else:
        wait_until(lambda: is_asleep(peer.pid), "it sleeps")
    assert peer.stop() == 0, peer
    assert "interrupted" in peer.lines
    assert platform not in manycore.platforms()


def hold_a_message() -> None:
    with transport.join() as member:
        message = member.subscription("/t", np.float32, qos=1).take()
        announce(f"holds {message.array[0]}")
        sys.stdin.read()


def test_a_process_is_killed_with_a_message_in_hand(start, platform: str) -> None:
    holder = start(peer_command(hold_a_message), cluster=2)
    with transport.join(platform) as member:
        publisher = member.publisher("/t", np.float32, qos=1)
        publisher.wait_for_subscriptions(1, TIMEOUT_S)
        publisher.publish(np.full(1000, 1.0, np.float32))
        holder.wait_for("^holds 1.0$")
        holder.kill()
        for number in range(100):
            publisher.publish(np.full(1000, number, np.float32))
        own = (os.getpid(),)
        wait_until(
            lambda: tuple(p.pid for p in manycore.status(platform).processes) == own,
            "the killed process is reaped",
        )
        wait_until(lambda: publisher.subscriptions == 0, "its subscription is gone")
        subscription = member.subscription("/t", np.float32, qos=1)
        publisher.publish(np.full(1000, 7.0, np.float32))
        assert subscription.take_copy(TIMEOUT_S)[0] == 7.0


def subscribe() -> None:
    with transport.join() as member, member.subscription("/t", np.int32):
        sys.stdin.read()


def test_what_is_not_transferred_is_a_loss_of_its_publisher(start, platform: str) -> None:
    topic = _transport.TopicConfiguration(
        "/t", id=1, dsm_size_bytes=4 << 20, receiver_clusters=0, transfer="message"
    )
    with _transport.Configurator(
        platform,
        clusters=2,
        cores_per_cluster=4,
        smem_bytes=64 << 20,
        host_cpu_of_receive_thread={},
        topics=[topic],
    ):
        start(peer_command(subscribe), cluster=2)
        with transport.join(platform) as member:
            publisher = member.publisher("/t", np.int32)
            publisher.wait_for_subscriptions(1, TIMEOUT_S)
            wait_until(lambda: receive_thread_of(platform, 2), "its receive thread runs")
            with stopped(receive_thread_of(platform, 2)):
                array = np.zeros(1000, np.int32)
                wait_until(
                    lambda: publisher.publish(array) and manycore.status(platform).losses,
                    "the pipe is full",
                )
                (row,) = manycore.status(platform).losses
                assert (row.kind, row.topic, row.dropped) == ("publisher", "/t", 1)


def receive_thread_of(platform: str, cluster: int) -> int | None:
    return manycore.status(platform).clusters[cluster - 1].receive_thread_pid


@contextmanager
def stopped(pid: int) -> Iterator[None]:
    """Stop a process meanwhile."""
    os.kill(pid, signal.SIGSTOP)
    try:
        wait_until(lambda: is_stopped(pid), "it is stopped")
        yield
    finally:
        os.kill(pid, signal.SIGCONT)


def fork_with_a_message() -> None:
    with transport.join() as member:
        publisher = member.publisher("/t", np.int32)
        subscription = member.subscription("/t", np.int32)
        publisher.publish(np.array([1], np.int32))
        with subscription.take(TIMEOUT_S) as message:
            child = os.fork()
            if child == 0:
                os._exit(_as_child(publisher, subscription))
            assert os.waitstatus_to_exitcode(os.waitpid(child, 0)[1]) == 0
            assert message.array[0] == 1
        publisher.publish(np.array([3], np.int32))
        assert [int(subscription.take_copy(TIMEOUT_S)[0]) for _ in range(2)] == [2, 3]
    announce("the parent goes on")


def _as_child(
    publisher: transport.Publisher[Any], subscription: transport.Subscription[Any]
) -> int:
    """Use what is inherited, then join anew; return the exit status."""
    inherited = (
        lambda: publisher.publish(np.array([9], np.int32)),
        lambda: publisher.wait_for_subscriptions(9),
        subscription.take,
    )
    for act in inherited:
        try:
            act()
        except transport.TransportError as error:
            announce(f"refused: {error}")
    with transport.join(name="child") as member:
        own = member.publisher("/t", np.int32)
        own.wait_for_subscriptions(1, TIMEOUT_S)
        own.publish(np.array([2], np.int32))
    return 0


@pytest.mark.filterwarnings("ignore:.*multi-threaded, use of fork:DeprecationWarning")
def test_a_forked_child_joins_anew(start) -> None:
    peer = start(peer_command(fork_with_a_message))
    assert peer.wait() == 0, peer
    assert "the parent goes on" in peer.lines
    refused = [line for line in peer.lines if line.startswith("refused: ")]
    assert len(refused) == 3, peer
    assert all("fork()" in line for line in refused), peer


def publish_from_ros() -> None:
    from std_msgs.msg import Float64MultiArray, MultiArrayDimension, MultiArrayLayout

    with peer_node("talker") as node:
        publisher = node.create_publisher(Float64MultiArray, "/from_ros", 10)
        spin_until(node, publisher.get_subscription_count)
        dimensions = [
            MultiArrayDimension(label="rows", size=2, stride=6),
            MultiArrayDimension(label="columns", size=3, stride=3),
        ]
        layout = MultiArrayLayout(dim=dimensions)
        publisher.publish(Float64MultiArray(layout=layout, data=[1.0, 2.0, 3.0, 4.0, 5.0, 6.0]))
        publisher.publish(Float64MultiArray(data=[7.0, 8.0]))
        publisher.publish(Float64MultiArray(layout=layout, data=[9.0]))
        sys.stdin.read()


def test_arrays_of_a_ros_node_are_taken(start, platform: str) -> None:
    start(peer_command(publish_from_ros), cluster=2)
    with transport.join(platform) as member:
        subscription = member.subscription("/from_ros", np.float64)
        assert subscription.take_copy(TIMEOUT_S).tolist() == [[1, 2, 3], [4, 5, 6]]
        with subscription.take(TIMEOUT_S) as message:
            assert message.array.tolist() == [7, 8]
            assert message.array.mean() == 7.5
        with (
            pytest.raises(transport.TransportError, match=r"\(2, 3\) do not make up its 1 elem"),
            subscription.take(TIMEOUT_S) as message,
        ):
            message.array  # noqa: B018 - the look is the test


def subscribe_from_ros(kinds: list[str]) -> None:
    import std_msgs.msg

    with peer_node("listener") as node:
        heard: list[str] = []

        def hear(kind: str) -> Any:
            def callback(message: Any) -> None:
                sizes = [dimension.size for dimension in message.layout.dim]
                heard.append(kind)
                announce(f"{kind} {sizes} {message.layout.dim[0].stride} {list(message.data)}")

            return callback

        for kind in kinds:
            message_type = getattr(std_msgs.msg, f"{kind}MultiArray")
            node.create_subscription(message_type, f"/{kind}", hear(kind), 10)
        spin_until(node, lambda: len(heard) == len(kinds))


def test_arrays_are_heard_by_a_ros_node(start, platform: str) -> None:
    kinds = {"Float32": np.float32, "Float64": np.float64, "UInt16": np.uint16, "Int64": np.int64}
    listener = start(peer_command(subscribe_from_ros, list(kinds)), cluster=2)
    with transport.join(platform) as member:
        for kind, dtype in kinds.items():
            publisher = member.publisher(f"/{kind}", dtype)
            publisher.wait_for_subscriptions(1, TIMEOUT_S)
            publisher.publish(np.arange(1, 7, dtype=dtype).reshape(3, 2))
        assert listener.wait() == 0, listener
    for kind in kinds:
        values = [1, 2, 3, 4, 5, 6] if "Int" in kind else [1.0, 2.0, 3.0, 4.0, 5.0, 6.0]
        assert f"{kind} [3, 2] 6 {values}" in listener.lines, listener
