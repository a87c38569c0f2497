# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""A node whose process executes a program with execve() is not there twice, or no longer."""

from __future__ import annotations

import os
import sys
import threading
from pathlib import Path

import pytest

from support import IS_MANYCORE

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

LEAVES = """
import os, time
import rclpy
from std_msgs.msg import String

rclpy.init()
publisher = rclpy.create_node("leaves").create_publisher(String, "spoken", 1)
while publisher.get_subscription_count() == 0:
    time.sleep(0.01)
os.execvp("sleep", ["sleep", "1000"])
"""
SEES = """
import time
import rclpy
from std_msgs.msg import String

rclpy.init()
node = rclpy.create_node("sees")
while "leaves" not in node.get_node_names():
    time.sleep(0.01)
subscription = node.create_subscription(String, "spoken", print, 1)
while node.get_node_names() != ["sees"] or node.count_publishers("spoken") != 0:
    time.sleep(0.01)
"""


def can_watch_threads() -> bool:
    """Return whether this kernel tells the end of a thread, as Linux 6.9 does."""
    try:
        os.close(os.pidfd_open(threading.get_native_id(), os.O_EXCL))
    except OSError:
        return False
    return True


def test_what_a_program_had_before_it_executed_itself_is_gone(start, tmp_path: Path) -> None:
    path = tmp_path / "restarting.py"
    path.write_text(PROGRAM)
    program = start([sys.executable, str(path), "first"])
    assert program.wait() == 0, program


@pytest.mark.skipif(not IS_MANYCORE, reason="Fast DDS waits for the end of a lease")
@pytest.mark.skipif(not can_watch_threads(), reason="needs Linux 6.9")
def test_a_process_that_executes_what_is_no_node_has_none(start) -> None:
    leaving = start([sys.executable, "-c", LEAVES])
    seeing = start([sys.executable, "-c", SEES])
    assert seeing.wait() == 0, seeing
    assert Path(f"/proc/{leaving.pid}/comm").read_text() == "sleep\n"
