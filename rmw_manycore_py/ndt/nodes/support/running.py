# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""Runs a node until interrupted; invalid parameters and files end it with an error message."""

from __future__ import annotations

import sys
import time
from collections.abc import Callable
from contextlib import suppress

import rclpy
from rclpy.executors import ExternalShutdownException
from rclpy.node import Node

from rmw_manycore_py.errors import ManycoreError

_SHUTDOWN_S = 1.0  # far more than rclpy takes from a signal until its context is shut down


def run_node(make: Callable[[], Node]) -> None:
    """Create a node and spin it; its `destroy_node` releases its resources."""
    rclpy.init()
    try:
        node = make()
    except ManycoreError as error:
        print(error, file=sys.stderr)
        rclpy.try_shutdown()
        sys.exit(error.exit_status)
    with suppress(KeyboardInterrupt, ExternalShutdownException):
        try:
            rclpy.spin(node)
        except RuntimeError:
            # Interrupted while rclpy converted a message, which it reports as an error of its own.
            if not _is_shut_down():
                raise
    node.destroy_node()
    rclpy.try_shutdown()


def _is_shut_down() -> bool:
    """Return whether rclpy is interrupted: another thread shuts down, soon after the signal."""
    until_s = time.monotonic() + _SHUTDOWN_S
    while rclpy.ok() and time.monotonic() < until_s:
        time.sleep(0.01)
    return not rclpy.ok()
