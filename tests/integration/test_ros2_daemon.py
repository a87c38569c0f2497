# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""A ros2cli daemon that outlives a run; a node with the daemon's command line stands in."""

from __future__ import annotations

import sys

import pytest

from support import IS_MANYCORE, MAPFILES, wait_until
from support.processes.commands import manycore_command
from support.processes.platforms import leftovers

pytestmark = [
    pytest.mark.integration,
    pytest.mark.skipif(not IS_MANYCORE, reason="manycore run is about rmw_manycore"),
]

RUN = manycore_command("run", MAPFILES / "talker_listener.yaml")
DAEMON = """
import rclpy
from rclpy.executors import ExternalShutdownException
rclpy.init()
node = rclpy.create_node("_ros2cli_daemon_0_0123456789abcdef", start_parameter_services=False)
print("serving", flush=True)
try:
    rclpy.spin(node)
except ExternalShutdownException:
    pass
"""


def test_a_daemon_left_behind_does_not_block_the_next_run(start, platform) -> None:
    daemon = start([sys.executable, "-c", DAEMON, "--name", "ros2cli.daemon"])
    daemon.wait_for("serving")
    doctor = start(manycore_command("doctor"))
    doctor.wait()
    assert f"ros2 daemon: {platform} (pid {daemon.pid})" in doctor.output
    run = start(RUN)
    run.wait_for(rf"the ros2 daemon \({daemon.pid}\) of an earlier run was stopped")
    daemon.wait()  # rclpy itself may fail on a signal that arrives while it spins
    run.wait_for("talker started")
    second = start([sys.executable, "-c", DAEMON, "--name", "ros2cli.daemon"])
    second.wait_for("serving")
    assert run.stop() == 0
    assert f"the ros2 daemon ({second.pid}; `ros2 daemon stop` stops it)" in run.output
    again = start(RUN)
    second.wait()
    again.wait_for("I heard")
    assert again.stop() == 0
    wait_until(lambda: leftovers(platform) == [], "nothing is left")


def test_another_node_is_never_taken_for_a_daemon(start, platform) -> None:
    node = start([sys.executable, "-c", DAEMON, "--name", "something-else"])
    node.wait_for("serving")
    run = start(RUN)
    assert run.wait() == 1
    assert f"platform '{platform}' is running already" in run.output
    assert node.is_running()
    node.stop()
