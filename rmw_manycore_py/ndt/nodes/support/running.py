# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""Running a node until it is interrupted; wrong parameters and files end it with a message."""

from __future__ import annotations

import sys
from collections.abc import Callable
from contextlib import suppress

import rclpy
from rclpy.executors import ExternalShutdownException
from rclpy.node import Node

from rmw_manycore_py.errors import ManycoreError


def run_node(make: Callable[[], Node]) -> None:
    """Make a node and spin it; its `destroy_node` releases what it has."""
    rclpy.init()
    try:
        node = make()
    except ManycoreError as error:
        print(error, file=sys.stderr)
        rclpy.try_shutdown()
        sys.exit(error.exit_status)
    with suppress(KeyboardInterrupt, ExternalShutdownException):
        rclpy.spin(node)
    node.destroy_node()
    rclpy.try_shutdown()
