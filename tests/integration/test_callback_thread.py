# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""The thread that calls callbacks, stopped by a preloaded library between two of its steps."""

from __future__ import annotations

import sys

import pytest

from support.processes.preloaded import preloaded

pytestmark = pytest.mark.integration

SHUT_DOWN = """
import rclpy
from rclpy.experimental import EventsExecutor

for _ in range(5):
    context = rclpy.Context()
    rclpy.init(context=context)
    node = rclpy.create_node("node", context=context)
    executor = EventsExecutor(context=context)
    executor.add_node(node)
    executor.spin_once(0.0)
    rclpy.shutdown(context=context)
"""


def test_it_ends_though_it_was_about_to_sleep(start, tmp_path) -> None:
    program = start([sys.executable, "-c", SHUT_DOWN], **preloaded("late_unlock", tmp_path))
    assert program.wait() == 0, program
