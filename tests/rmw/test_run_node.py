# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""Nodes of the stacks end without a traceback wherever an interrupt meets them."""

from __future__ import annotations

import sys

import pytest

pytestmark = pytest.mark.rmw

# As pybind11 does with an interrupt that arrives while it converts a message. The thread of rclpy
# that shuts down gets no CPU before this one waits, where the user may arrange that.
NODE = """
import contextlib, os, signal
from rclpy.node import Node
from rmw_manycore_py.ndt.nodes.support.running import run_node

class Converting(Node):
    def __init__(self):
        super().__init__("converting")
        self.create_timer(0.01, self.convert)

    def convert(self):
        with contextlib.suppress(PermissionError):
            os.sched_setscheduler(0, os.SCHED_FIFO, os.sched_param(1))
        try:
            if {interrupted}:
                signal.raise_signal(signal.SIGINT)
        finally:
            raise RuntimeError("Unable to convert call argument '0' to Python object")

os.sched_setaffinity(0, list(os.sched_getaffinity(0))[:1])
run_node(Converting)
"""


@pytest.mark.parametrize(("interrupted", "status"), [(True, 0), (False, 1)])
def test_an_interrupt_that_became_an_error(start, interrupted, status) -> None:
    """The error arrives before rclpy has shut down, which another thread of it does."""
    node = start([sys.executable, "-c", NODE.format(interrupted=interrupted)])
    assert node.wait() == status, node
    assert ("Unable to convert" in node.output) == (status == 1), node
