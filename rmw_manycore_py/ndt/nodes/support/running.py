# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""Runs a node until interrupted; invalid parameters and files end it with an error message."""

from __future__ import annotations

import signal
import sys
from collections.abc import Callable, Iterator
from contextlib import contextmanager

import rclpy
from rclpy.executors import ExternalShutdownException
from rclpy.node import Node

from rmw_manycore_py.errors import ManycoreError


def run_node(make: Callable[[], Node]) -> None:
    """Create a node and spin it; its `destroy_node` releases its resources."""
    # rclpy's own handler ends spinning. A KeyboardInterrupt inside of rclpy may become another
    # error, or one that Python prints and ignores.
    signal.signal(signal.SIGINT, lambda _number, _frame: None)
    rclpy.init()
    with _until_interrupted():
        try:
            node = make()
        except ManycoreError as error:
            print(error, file=sys.stderr)
            rclpy.try_shutdown()
            sys.exit(error.exit_status)
        with _until_interrupted():
            rclpy.spin(node)
        node.destroy_node()
    rclpy.try_shutdown()


@contextmanager
def _until_interrupted() -> Iterator[None]:
    """End the block where the interrupt invalidated the context that a call needs."""
    try:
        yield
    except ExternalShutdownException:
        pass
    except RuntimeError:  # of rcl
        if rclpy.ok():
            raise
