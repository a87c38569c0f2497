# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""An rclpy node on a platform, for the verbs that talk to other nodes.

rclpy is imported late: the other commands do without it, and it must find rmw_manycore loaded.
"""

from __future__ import annotations

import os
import signal
from collections.abc import Iterator
from contextlib import contextmanager, suppress
from typing import Any

from rmw_manycore_py.errors import ManycoreError
from rmw_manycore_py.launch.processes.environment import enter_middleware

# How long a node may take to answer that is there.
ANSWER_TIMEOUT_S = 5.0
# How often a spinning tool looks whether it was interrupted.
_LOOK_PERIOD_S = 0.1


@contextmanager
def tool_node(platform: str, name: str | None = None, *, sim_time: bool = False) -> Iterator[Any]:
    """Yield a node that runs until the block ends or is interrupted; both end it quietly.

    With `sim_time` its clock follows the topic /clock. An interrupt reaches the block as
    KeyboardInterrupt, while the node still works.
    """
    enter_middleware()
    os.environ["MANYCORE_PLATFORM"] = platform
    import rclpy
    from rclpy.parameter import Parameter
    from rclpy.signals import SignalHandlerOptions

    rclpy.init(args=[], signal_handler_options=SignalHandlerOptions.NO)
    node = rclpy.create_node(
        name or f"_manycore_{os.getpid()}",
        enable_rosout=False,
        start_parameter_services=False,
        parameter_overrides=[Parameter("use_sim_time", value=sim_time)],
    )
    try:
        with suppress(KeyboardInterrupt), _errors_of_rcl():
            yield node
    finally:
        node.destroy_node()
        rclpy.shutdown()


@contextmanager
def _errors_of_rcl() -> Iterator[None]:
    """Report what rcl refuses, a name or a QoS policy, without the places in its sources."""
    from rclpy._rclpy_pybind11 import RCLError
    from rclpy.exceptions import NameValidationException

    try:
        yield
    except (RCLError, NameValidationException) as error:
        raise ManycoreError(str(error).partition(", at ")[0]) from error


def spin_once(node: Any, timeout_s: float = _LOOK_PERIOD_S) -> None:
    """Handle what has come in, or wait a moment for it; an interrupt is raised afterwards."""
    import rclpy

    with _interrupts_held():
        rclpy.spin_once(node, timeout_sec=min(timeout_s, _LOOK_PERIOD_S))


@contextmanager
def _interrupts_held() -> Iterator[None]:
    """Let no interrupt in between the taking of a message and its handling, which would lose it."""
    noted: list[int] = []
    handler = signal.signal(signal.SIGINT, lambda number, _frame: noted.append(number))
    try:
        yield
    finally:
        signal.signal(signal.SIGINT, handler)
    if noted and callable(handler):
        handler(noted[0], None)


def result_of(node: Any, future: Any, whose: str) -> Any:
    """Spin until a future is done and return its result, however long that takes."""
    while not future.done():
        spin_once(node)
    if future.exception() is not None:
        raise ManycoreError(f"{whose}: {future.exception()}")
    return future.result()


def answer_of(node: Any, client: Any, request: Any) -> Any:
    """Call a service that should be there, and return its response."""
    if not client.wait_for_service(ANSWER_TIMEOUT_S):
        raise ManycoreError(f"no service '{client.service_name}' within {ANSWER_TIMEOUT_S:g} s")
    return result_of(node, client.call_async(request), client.service_name)
