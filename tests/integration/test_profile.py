# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""Profiles of real nodes, beside what the nodes do."""

from __future__ import annotations

import json
from pathlib import Path

import pytest

from rmw_manycore_py.profile.files import load
from rmw_manycore_py.profile.model import Callback, Profile
from support import IS_MANYCORE
from support.generated.ctf import made, write_trace
from support.peers.programs import forked_manycore
from support.processes.commands import manycore_command

pytestmark = [
    pytest.mark.integration,
    pytest.mark.skipif(not IS_MANYCORE, reason="manycore is about rmw_manycore"),
]

BUSY_MS, ASLEEP_MS = 5, 20
NODE = f"""
import time
import rclpy
from rclpy.node import Node
from std_msgs.msg import String

rclpy.init()
node = Node("worker")
publisher = node.create_publisher(String, "done", 10)
heard = node.create_publisher(String, "heard", 10)

def work():
    begin_s = time.thread_time()
    while time.thread_time() - begin_s < {BUSY_MS / 1000}:
        pass
    time.sleep({ASLEEP_MS / 1000})
    publisher.publish(String(data="x" * 1000))

node.create_timer(0.1, work)
node.create_subscription(String, "done", heard.publish, 10)
rclpy.spin(node)
"""


def of_kind(profile: Profile, kind: str) -> Callback:
    """Return the callback of a kind that publishes."""
    (found,) = [one for one in profile.callbacks if one.kind == kind and one.publishes]
    return found


def test_a_profile_describes_the_nodes(start, tmp_path: Path, platform) -> None:
    (tmp_path / "worker.py").write_text(NODE)
    mapfile = tmp_path / "map.yaml"
    mapfile.write_text("nodes:\n  worker: {cluster: 1, core: 1, script: worker.py}\n")
    path = tmp_path / "app.profile.json"
    run = start(manycore_command("profile", "record", mapfile, "--duration", "3", "-o", path))
    assert run.wait() == 0, run
    assert "trace.csv" not in run.output  # a temporary file, gone by now
    profile = load(path)
    assert [node.name for node in profile.nodes] == ["/worker"]
    timer, subscription = of_kind(profile, "timer"), of_kind(profile, "subscription")
    (done,), (heard,) = timer.publishes, subscription.publishes
    assert timer.executions == done.count
    assert done.count is not None
    assert done.count > 3
    assert timer.wall_ns is not None
    assert timer.cpu_ns is not None
    # The callback's share of a CPU is that of its thread between two waits.
    assert timer.wall_ns.quantiles[0] >= (BUSY_MS + ASLEEP_MS) * 1e6
    assert BUSY_MS * 0.9e6 < timer.cpu_ns.mean < timer.wall_ns.mean - ASLEEP_MS * 0.8e6
    assert done.offset_ns is not None
    assert done.offset_ns.quantiles[0] >= (BUSY_MS + ASLEEP_MS) * 1e6
    publisher = profile.publishers[done.publisher]
    assert (publisher.topic, publisher.node) == ("/done", 0)
    assert publisher.size_bytes is not None
    assert publisher.size_bytes.quantiles[0] > 1000
    assert (subscription.trigger, profile.publishers[heard.publisher].topic) == ("/done", "/heard")
    assert heard.count is not None
    assert abs(heard.count - done.count) <= 2  # at either end


def test_a_profile_may_last_until_the_run_is_stopped(start, tmp_path: Path, platform) -> None:
    path = tmp_path / "app.profile.json"
    words = ("profile", "record", "talker_listener", "--duration", "inf", "-o", path)
    run = start(manycore_command(*words))
    run.wait_for("I heard: 'Hello World: 3'")
    assert run.stop() == 0, run
    assert any(one.kind == "subscription" for one in load(path).callbacks)


def test_a_trace_is_imported_and_shown(start, tmp_path: Path) -> None:
    trace = write_trace(
        tmp_path / "trace",
        [
            made(0, "rcl_node_init", 1, 1, node_handle=5, node_name="n", namespace="/"),
            made(1, "rcl_subscription_init", 1, 1, subscription_handle=6, node_handle=5,
                 topic_name="/in"),
            made(2, "rclcpp_subscription_init", 1, 1, subscription_handle=6, subscription=7),
            made(3, "rclcpp_subscription_callback_added", 1, 1, subscription=7, callback=8),
            made(1000, "callback_start", 1, 1, callback=8),
            made(3000, "callback_end", 1, 1, callback=8),
        ],
    )  # fmt: skip
    path = tmp_path / "app.profile.json"
    imported = start(forked_manycore("profile", "import", str(trace), "-o", str(path)))
    assert imported.wait() == 0, imported
    imported.wait_for("1 node, 1 callback, 1 execution")
    shown = start(forked_manycore("profile", "show", str(path), "--json"))
    assert shown.wait() == 0, shown
    summary = json.loads(shown.output)
    assert (summary["nodes"], summary["callbacks"], summary["executions"]) == (1, 1, 1)
    assert summary["cpus_busy"] == pytest.approx(2 / 3)
    shown = start(forked_manycore("profile", "show", str(path)))
    shown.wait_for("/n +subscription /in +")
    assert shown.wait() == 0
    wrong = start(forked_manycore("profile", "import", str(trace), "--begin", "2", "--end", "1"))
    assert wrong.wait() == 2
    wrong.wait_for("expected --begin before --end, found 2 and 1")
