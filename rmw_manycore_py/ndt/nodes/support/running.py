# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""Runs a node until interrupted; invalid parameters and files end it with an error message."""

from __future__ import annotations

import sys
from collections.abc import Callable
from contextlib import suppress

import rclpy
from rclpy.executors import ExternalShutdownException
from rclpy.node import Node

from rmw_manycore_py.errors import ManycoreError


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
            if rclpy.ok():
                raise
            # Interrupted while rclpy converted a message, which it reports as an error of its own.
    node.destroy_node()
    rclpy.try_shutdown()
