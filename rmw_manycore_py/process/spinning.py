# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""Spinning a node of rclpy that interrupts end between two calls of rclpy, not in one.

Imports rclpy late: some commands have to load rmw_manycore before it.
"""

from __future__ import annotations

import signal
from collections.abc import Iterable
from typing import Any

from rmw_manycore_py.process.signals import interrupts_held

LOOK_PERIOD_S = 0.1  # at which a pending interrupt is raised


def spin_once(
    node: Any,
    timeout_s: float = LOOK_PERIOD_S,
    signals: Iterable[signal.Signals] = (signal.SIGINT,),
) -> None:
    """Handle one pending callback, waiting up to the timeout [s]; then raise a pending interrupt.

    No message is lost between taking and handling it. Wants a context without rclpy's own signal
    handlers, which would shut it down while the node is spinning.
    """
    import rclpy

    with interrupts_held(signals):
        rclpy.spin_once(node, timeout_sec=min(timeout_s, LOOK_PERIOD_S))
