# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""A node that starts its program again with execve() is not there twice."""

from __future__ import annotations

import sys
from pathlib import Path

import pytest

pytestmark = pytest.mark.integration

PROGRAM = """
import os, sys, time
import rclpy
from std_msgs.msg import String

name = sys.argv[1]
rclpy.init()
node = rclpy.create_node(name)
publisher = node.create_publisher(String, "spoken", 1)
if name == "first":
    os.execv(sys.executable, [sys.executable, __file__, "second"])
while node.get_node_names() != ["second"] or node.count_publishers("spoken") != 1:
    time.sleep(0.01)
"""


def test_what_a_program_had_before_it_executed_itself_is_gone(start, tmp_path: Path) -> None:
    path = tmp_path / "restarting.py"
    path.write_text(PROGRAM)
    program = start([sys.executable, str(path), "first"])
    assert program.wait() == 0, program
