# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""Nodes with rclpy's MultiThreadedExecutor on the single CPU of their core."""

from __future__ import annotations

import json
import subprocess
import sys
from pathlib import Path

import pytest

from support import IS_MANYCORE
from support.peers.programs import forked_manycore
from support.processes.platforms import environment

pytestmark = [
    pytest.mark.integration,
    pytest.mark.skipif(not IS_MANYCORE, reason="manycore run is about rmw_manycore"),
]

# As in the ROS 2 tutorial on callback groups: a timer callback calls a service and waits.
CALLER = """
import os, sys
import rclpy
from rclpy.callback_groups import MutuallyExclusiveCallbackGroup
from rclpy.executors import MultiThreadedExecutor
from rclpy.node import Node
from std_srvs.srv import Empty

rclpy.init()
node = Node("caller")
groups = [MutuallyExclusiveCallbackGroup() for _ in range(3)]
node.create_service(Empty, "served", lambda _, response: response, callback_group=groups[0])
client = node.create_client(Empty, "served", callback_group=groups[1])

def call():
    client.call(Empty.Request())
    print("answered on", len(os.sched_getaffinity(0)), "CPU", flush=True)

node.create_timer(0.1, call, callback_group=groups[2])
executor = MultiThreadedExecutor()
executor.add_node(node)
executor.spin()
"""
SHOW = """
import json, os, sys
at_start = "rclpy" in sys.modules
from concurrent.futures import ThreadPoolExecutor
os.sched_setaffinity(0, {min(os.sched_getaffinity(0))})
import rclpy
from rclpy.executors import MultiThreadedExecutor
class Own(MultiThreadedExecutor):
    pass
rclpy.init()
threads = [e._executor._max_workers for e in
           (MultiThreadedExecutor(), Own(), MultiThreadedExecutor(1), MultiThreadedExecutor(3))]
print(json.dumps([at_start, threads, len(os.sched_getaffinity(0))]))
"""


def test_a_callback_may_wait_for_another_one(start, tmp_path: Path, platform) -> None:
    (tmp_path / "caller.py").write_text(CALLER)
    mapfile = tmp_path / "map.yaml"
    mapfile.write_text("nodes:\n  caller: {cluster: 1, core: 1, script: caller.py}\n")
    run = start(forked_manycore("run", mapfile))
    for _ in range(3):
        run.wait_for(r"^caller   \| answered on 1 CPU$")
    assert run.stop() == 0


@pytest.mark.parametrize(("core", "threads"), [({"MANYCORE_CORE": "1"}, 2), ({}, 1)])
def test_only_the_default_of_placed_nodes_changes(
    platform: str, core: dict[str, str], threads: int
) -> None:
    result = subprocess.run(
        [sys.executable, "-W", "ignore", "-c", SHOW],
        env=environment(platform, **core),
        check=True,
        capture_output=True,
        text=True,
    )
    at_start, found, cpus = json.loads(result.stdout)
    assert not at_start, "rclpy is imported only by those that want it"
    assert found == [threads, threads, 1, 3]
    assert cpus == 1, "the affinity is told as it is"


def test_a_program_without_rclpy_is_left_alone(platform: str) -> None:
    code = "import sys; print([name for name in sys.modules if name.startswith('rclpy')])"
    env = environment(platform, MANYCORE_CORE="1")
    command = [sys.executable, "-c", code]
    result = subprocess.run(command, env=env, check=True, capture_output=True, text=True)
    assert result.stdout.strip() == "[]"
