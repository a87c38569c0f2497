# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""Programs that keep all messages: at the limit one warning and copies, and nothing else waits."""

from __future__ import annotations

import os
import re
import sys
from typing import Any

import pytest
import rclpy
from std_msgs.msg import UInt8MultiArray

from rmw_manycore_py.native import _transport
from support import IS_MANYCORE
from support.nodes.exchanging import in_record, large
from support.nodes.ros import announce, lost_messages, peer_node, spin_until

pytestmark = pytest.mark.skipif(not IS_MANYCORE, reason="others copy")

BESIDE_DEPTH = 4  # held as well, see docs/design/holds.md
SMEM_BYTES = 16 << 20
BYTES = 1 << 20
FILLED = SMEM_BYTES // 2 // BYTES
MANY = 3 * FILLED


def keep_all(depth: int) -> None:
    """Keep each message that is taken; at last check all of them."""
    with peer_node() as node:
        kept: list[Any] = []
        node.create_subscription(UInt8MultiArray, "large", kept.append, depth)
        for number in range(MANY):
            spin_until(node, lambda number=number: len(kept) > number)
            announce(f"taken {number}")
        same = all(
            one.data == large(seed=number, size_bytes=BYTES) for number, one in enumerate(kept)
        )
        announce(f"{same}, {sum(in_record(one.data) for one in kept)} in place")


def little_memory() -> None:
    """Configure a platform, in another process: rclpy's library would not see it in this one."""
    with _transport.Configurator(
        os.environ["MANYCORE_PLATFORM"],
        clusters=2,
        cores_per_cluster=4,
        smem_bytes=SMEM_BYTES,
        host_cpu_of_receive_thread={},
        topics=[],
    ):
        announce("configured")
        sys.stdin.read()


@pytest.mark.parametrize(
    ("depth", "places", "limit"),
    [
        (2, 2 + BESIDE_DEPTH, r"keeps 6 of them, the limit of its depth and 4; .* raise the depth"),
        (MANY, FILLED - 2, r"half of cluster 1, and \d+ of its 16777216 .* raise smem_size"),
    ],
    ids=["depth", "memory"],
)
def test_one_warning_and_copies(start_peer, depth, places, limit):
    start_peer(little_memory).wait_for("configured")
    rclpy.init()
    node = rclpy.create_node("tester")
    publisher = node.create_publisher(UInt8MultiArray, "large", depth)
    peer = start_peer(keep_all, depth)
    spin_until(node, publisher.get_subscription_count)
    for number in range(MANY):
        publisher.publish(UInt8MultiArray(data=large(seed=number, size_bytes=BYTES)))
        peer.wait_for(f"^taken {number}$")
    peer.wait_for(f"^True, {places} in place$")
    assert lost_messages("/large") == 0
    assert peer.wait() == 0
    assert re.search(rf"messages on '/large' are copied: .*{limit}", peer.output)
    assert peer.output.count("are copied") == 1
    node.destroy_node()
    rclpy.shutdown()
