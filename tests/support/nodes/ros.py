# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""Helpers around rclpy for tests and their peers."""

from __future__ import annotations

import importlib
import os
import threading
import time
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from typing import Any

import rclpy
from rclpy._rclpy_pybind11 import RCLError
from rclpy.executors import Executor, ExternalShutdownException
from rclpy.node import Node
from rclpy.signals import uninstall_signal_handlers
from rclpy.task import Future

from support import TIMEOUT_S


def spin_until(node: Node, condition: Callable[[], Any], timeout_s: float = TIMEOUT_S) -> None:
    """Spin a node until a condition holds, which its callbacks make true."""
    deadline = time.monotonic() + timeout_s
    while not condition():
        if time.monotonic() > deadline:
            raise AssertionError(f"not within {timeout_s:g} s of spinning")
        rclpy.spin_once(node, timeout_sec=0.05)


@contextmanager
def spinning_thread(executor: Executor) -> Iterator[threading.Thread]:
    """Spin an executor in a new thread, and yield it.

    A future ends the spinning: `Executor.shutdown` destroys what a thread that is about to wait
    still uses.
    """
    enough = Future()
    thread = threading.Thread(
        target=executor.spin_until_future_complete, args=(enough,), daemon=True
    )
    thread.start()
    yield thread
    enough.set_result(None)
    thread.join(TIMEOUT_S)
    assert not thread.is_alive()


def spin(node: Node) -> None:
    """Spin the node of a peer; a callback prints "spinning".

    From then on SIGINT ends the peer quietly. Before, rclpy may still be creating the executor, and
    would report the end of its context as an error.
    """
    rclpy.get_global_executor().create_task(announce, "spinning")
    rclpy.spin(node)


@contextmanager
def peer_node(name: str = "peer", **options: Any) -> Iterator[Node]:
    """Give a peer process its node; it ends quietly on SIGINT."""
    rclpy.init()
    node = rclpy.create_node(name, **options)
    try:
        yield node
    except (KeyboardInterrupt, ExternalShutdownException):
        pass
    except RCLError:  # rclpy looks at the context before it makes the wait set
        if rclpy.ok():
            raise
    # Waits until rclpy's signal thread has triggered the guard conditions that are destroyed next.
    uninstall_signal_handlers()
    node.destroy_node()
    rclpy.try_shutdown()


def announce(line: str) -> None:
    """Print a line for the waiting test, in one write, as several threads may print at once."""
    print(f"{line}\n", end="", flush=True)


def type_of(name: str) -> Any:
    """Return the class of a type name such as "std_msgs/msg/String"."""
    package, kind, type_name = name.split("/")
    return getattr(importlib.import_module(f"{package}.{kind}"), type_name)


def lost_messages(topic: str, role: str = "topic") -> int:
    """Return the table of lost messages, requests and responses that the tools print."""
    from rmw_manycore_py.native import _transport

    with _transport.Platform(os.environ["MANYCORE_PLATFORM"]) as platform:
        return sum(
            endpoint.counters.lost
            for endpoint in platform.endpoints()
            if (endpoint.topic, endpoint.role) == (topic, role)
        )
