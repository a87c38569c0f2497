# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""An rclpy node on a platform, for verbs that talk to other nodes.

Imports rclpy late: other commands do not need it, and rmw_manycore has to be loaded before it.
"""

from __future__ import annotations

import os
from collections.abc import Callable, Iterator
from contextlib import contextmanager, nullcontext, suppress
from typing import Any

from rmw_manycore_py.errors import ManycoreError
from rmw_manycore_py.launch.processes.environment import enter_middleware
from rmw_manycore_py.process.signals import interrupts_held
from rmw_manycore_py.process.spinning import spin_once

# Timeout for the answer of a node that exists.
ANSWER_TIMEOUT_S = 5.0


@contextmanager
def tool_node(
    platform: str, name: str | None = None, *, sim_time: bool = False, until_ctrl_c: bool = False
) -> Iterator[Any]:
    """Yield a node until the block ends or an interrupt ends it; shut down quietly either way.

    With `sim_time` the node's clock follows /clock. An interrupt raises KeyboardInterrupt in the
    block while the node is still usable. With `until_ctrl_c` it goes no further than the block,
    and what follows the block runs.
    """
    enter_middleware()
    os.environ["MANYCORE_PLATFORM"] = platform
    with any_node(name, sim_time=sim_time, until_ctrl_c=until_ctrl_c) as node:
        yield node


@contextmanager
def any_node(
    name: str | None = None, *, sim_time: bool = False, until_ctrl_c: bool = False
) -> Iterator[Any]:
    """Yield a node like :func:`tool_node`, of the middleware that is loaded."""
    import rclpy
    from rclpy.parameter import Parameter
    from rclpy.signals import SignalHandlerOptions

    node = None
    try:
        with interrupts_held():
            rclpy.init(args=[], signal_handler_options=SignalHandlerOptions.NO)
            node = rclpy.create_node(
                name or f"_manycore_{os.getpid()}",
                enable_rosout=False,
                start_parameter_services=False,
                parameter_overrides=[Parameter("use_sim_time", value=sim_time)],
            )
        with suppress(KeyboardInterrupt) if until_ctrl_c else nullcontext():
            yield node
    finally:
        with interrupts_held():
            if node is not None:
                node.destroy_node()
            rclpy.try_shutdown()


def result_of(node: Any, ask: Callable[[], Any], whose: str) -> Any:
    """Ask, spin until the future is done, and return its result; no timeout."""
    with interrupts_held():
        future = ask()
    while not future.done():
        spin_once(node)
    if future.exception() is not None:
        raise ManycoreError(f"{whose}: {future.exception()}")
    return future.result()


def answer_of(node: Any, client: Any, request: Any) -> Any:
    """Call a service that is expected to exist, and return its response."""
    if not client.wait_for_service(ANSWER_TIMEOUT_S):
        raise ManycoreError(f"no service '{client.service_name}' within {ANSWER_TIMEOUT_S:g} s")
    return result_of(node, lambda: client.call_async(request), client.service_name)
