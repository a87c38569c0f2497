# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""The receive designs of ROS-lite: a callback queue, or a function per topic."""

from __future__ import annotations

import sys
from pathlib import Path

import pytest

from support import IS_MANYCORE, TIMEOUT_S
from support.peers.programs import forked_manycore

pytestmark = [
    pytest.mark.integration,
    pytest.mark.skipif(not IS_MANYCORE, reason="manycore run is about rmw_manycore"),
]

TALKER = """
import rclpy
from std_msgs.msg import Int32

rclpy.init()
node = rclpy.create_node("talker")
publishers = [node.create_publisher(Int32, topic, 10) for topic in ("one", "two")]
node.create_timer(0.005, lambda: [publisher.publish(Int32()) for publisher in publishers])
rclpy.spin(node)
"""
# Each callback waits until that of the other topic runs as well, which none does after SIGINT.
MEETING = f"""
import threading
import rclpy
from std_msgs.msg import Int32

rclpy.init()
node = rclpy.create_node("listener")
both = threading.Barrier(2, lambda: print("both", flush=True), timeout={TIMEOUT_S})
for topic in ("one", "two"):
    node.create_subscription(Int32, topic, lambda _: both.wait(), 10)
try:
    rclpy.spin(node)
finally:
    both.abort()
"""
# Its groups and its executor let callbacks overlap. SPEND_TIME is what each does: `compute`, or
# `wait_for_another` to overlap with.
OVERLAPPING = f"""
import threading, time
import rclpy
from rclpy.callback_groups import ReentrantCallbackGroup
from rclpy.executors import MultiThreadedExecutor
from std_msgs.msg import Int32

rclpy.init()
node = rclpy.create_node("listener")
running, most, calls = set(), 0, 0
met = threading.Event()

def call(message):
    global most, calls
    running.add(threading.get_ident())
    most = max(most, len(running))
    if most > 1:
        met.set()
    spend_time()
    running.discard(threading.get_ident())
    calls += 1
    if calls == 60:
        print("at most", most, flush=True)

def compute():
    end = time.thread_time() + 0.003
    while time.thread_time() < end:
        pass

def wait_for_another():
    met.wait({TIMEOUT_S})

spend_time = SPEND_TIME
for topic in ("one", "two"):
    node.create_subscription(Int32, topic, call, 10, callback_group=ReentrantCallbackGroup())
executor = MultiThreadedExecutor(4)
executor.add_node(node)
executor.spin()
"""


def run_listener(start, directory: Path, code: str, *keys: str):
    (directory / "talker.py").write_text(TALKER)
    (directory / "listener.py").write_text(code)
    mapfile = directory / "map.yaml"
    more = "".join(f", {key}" for key in keys)
    mapfile.write_text(
        "nodes:\n  talker: {cluster: 1, core: 1, script: talker.py}\n"
        f"  listener: {{cluster: 2, core: 1, script: listener.py{more}}}\n"
    )
    return start(forked_manycore("run", mapfile))


def test_per_topic_serves_each_topic_beside_the_others(start, tmp_path, platform) -> None:
    run = run_listener(start, tmp_path, MEETING, "receive: per_topic")
    for _ in range(3):
        run.wait_for(r"^listener \| both$")
    assert run.stop() == 0


def test_queue_keeps_callbacks_from_overlapping(start, tmp_path, platform) -> None:
    code = OVERLAPPING.replace("SPEND_TIME", "compute")
    run = run_listener(start, tmp_path, code, "receive: queue")
    assert run.wait_for(r"^listener \| at most (\d+)$").group(1) == "1"
    assert run.stop() == 0


def test_without_the_key_a_program_does_as_it_does(start, tmp_path, platform) -> None:
    run = run_listener(start, tmp_path, OVERLAPPING.replace("SPEND_TIME", "wait_for_another"))
    assert int(run.wait_for(r"^listener \| at most (\d+)$").group(1)) > 1
    assert run.stop() == 0


@pytest.mark.parametrize(
    ("code", "lines"),
    [
        ("import rclpy", ["MANYCORE_RECEIVE='pigeon' is not valid: expected queue or per_topic"]),
        ("import json", []),
    ],
)
def test_an_unknown_design_is_refused_by_rclpy(start, code: str, lines: list[str]) -> None:
    program = start([sys.executable, "-c", code], MANYCORE_CORE="1", MANYCORE_RECEIVE="pigeon")
    assert program.wait() == len(lines), program
    assert program.lines == lines
