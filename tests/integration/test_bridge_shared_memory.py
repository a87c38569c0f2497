# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""A killed bridge leaves unread messages in the shared memory of publishers outside.

Messages of SMALL_BYTES fill such a publisher's segment. Then the oldest one is freed for one of
LARGE_BYTES, which fits neither into the freed space nor into the rest, only into their sum: Fast
DDS frees no more and drops every message of that size.
"""

from __future__ import annotations

import os
import re
import select
import signal
import sys

import pytest
from std_msgs.msg import UInt8MultiArray

from rmw_manycore_bridge.fastdds.transports import NOTICE, PROFILES, TRANSPORTS, avoid_shared_memory
from rmw_manycore_py.routes.plan import Plan
from rmw_manycore_py.routes.route import arranged
from support import IS_MANYCORE
from support.nodes.ros import announce, peer_node, spin_until

pytestmark = [
    pytest.mark.integration,
    pytest.mark.skipif(not IS_MANYCORE, reason="the bridge is part of rmw_manycore"),
]

TOPIC, TYPE = "/cloud", "std_msgs/msg/UInt8MultiArray"
FIRST_BYTES, SMALL_BYTES, LARGE_BYTES = 1000, 30_000, 35_000
SMALL_COUNT = 17  # of 512 KiB, the segment of a publisher on Fast DDS
PERIOD_S = 0.05
FOREVER_S = 1e6


def publish_clouds() -> None:
    """On a line of input fill the segment, then publish a message that does not fit into it."""
    with peer_node("lidar") as node:
        publisher = node.create_publisher(UInt8MultiArray, TOPIC, 5)

        def publish(size_bytes: int) -> None:
            publisher.publish(UInt8MultiArray(data=bytes(size_bytes)))

        first = node.create_timer(PERIOD_S, lambda: publish(FIRST_BYTES))
        spin_until(node, lambda: select.select([sys.stdin], [], [], 0)[0], FOREVER_S)
        node.destroy_timer(first)
        for _ in range(SMALL_COUNT):
            publish(SMALL_BYTES)
        publish(LARGE_BYTES)
        announce("filled")
        node.create_timer(PERIOD_S, lambda: publish(LARGE_BYTES))
        spin_until(node, lambda: False, FOREVER_S)


def show_sizes() -> None:
    with peer_node("matcher") as node:
        node.create_subscription(
            UInt8MultiArray, TOPIC, lambda message: announce(f"heard {len(message.data)}"), 5
        )
        spin_until(node, lambda: False, FOREVER_S)


@pytest.mark.parametrize("discovery_range", ["LOCALHOST", "SYSTEM_DEFAULT"])
def test_large_messages_reach_the_process_that_replaces_a_killed_one(
    bridge, discovery_range
) -> None:
    env = {"ROS_AUTOMATIC_DISCOVERY_RANGE": discovery_range}
    plan = Plan(bridge.platform, arranged([bridge.route("inward", TOPIC, TYPE)], 1))
    lidar, matcher = bridge.outside(publish_clouds, **env), bridge.inside(show_sizes)
    first = bridge.run_one(plan, "inward", **env)
    matcher.wait_for(f"^heard {FIRST_BYTES}$")
    os.kill(first.pid, signal.SIGKILL)
    first.wait()
    lidar.say("the process that listens is gone")
    lidar.wait_for("^filled$")
    second = bridge.run_one(plan, "inward", **env)
    matcher.wait_for(f"^heard {LARGE_BYTES}$")
    assert NOTICE not in first.lines
    second.wait_for(f"^{re.escape(NOTICE)}$")


@pytest.mark.parametrize("chosen", [{TRANSPORTS: "SHM"}, {PROFILES: "my.xml"}])
def test_transports_that_a_user_chose_stay(chosen, tmp_path) -> None:
    environment = dict(chosen)
    assert not avoid_shared_memory(environment, tmp_path / "profile.xml")
    assert environment == chosen


def test_a_process_for_this_host_alone_finds_static_peers_too(tmp_path) -> None:
    profile = tmp_path / "profile.xml"
    environment = {"ROS_LOCALHOST_ONLY": "1", "ROS_STATIC_PEERS": "10.0.0.1;robot"}
    assert avoid_shared_memory(environment, profile)
    assert "ROS_LOCALHOST_ONLY" not in environment  # rcl would leave the choice to it
    assert environment[PROFILES] == str(profile)
    addresses = re.findall("<address>(.*?)</address>", profile.read_text())
    assert addresses == ["127.0.0.1", "10.0.0.1", "robot"]
