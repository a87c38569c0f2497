# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""What a mapping says, compared with what real nodes do."""

from __future__ import annotations

import pytest
from support import IS_MANYCORE, manycore_command, wait_until

from rmw_manycore_py.errors import ManycoreError
from rmw_manycore_py.mapfile import check
from rmw_manycore_py.platform.status import status

pytestmark = [
    pytest.mark.integration,
    pytest.mark.skipif(not IS_MANYCORE, reason="manycore run is about rmw_manycore"),
]

QUIET = """\
import rclpy
from rclpy.qos import QoSProfile
from std_msgs.msg import String

rclpy.init()
node = rclpy.create_node("node")
{endpoints}
rclpy.spin(node)
"""
NODES = {
    "first": (
        'a = node.create_publisher(String, "fixed", 50)\n'
        'b = node.create_publisher(String, "sent", QoSProfile(depth=3))\n'
        'c = node.create_publisher(String, "grows", 10)\n'
    ),
    "second": (
        'a = node.create_subscription(String, "fixed", print, 100)\n'
        'b = node.create_subscription(String, "sent", print, qos_profile=QoSProfile(depth=300))\n'
        'c = node.create_subscription(String, "grows", print, 10)\n'
    ),
}
PLATFORMS = {
    "granules of 1 KiB": "coolidge",
    "granules of a page": "{profile: host, clusters: 2, smem_size: 96MiB}",
}
ENDPOINTS = 2 * (2 + 7 * 2 + 3)


@pytest.mark.parametrize("kind", PLATFORMS)
def test_nodes_take_the_memory_that_is_predicted(start, tmp_path, platform, kind: str) -> None:
    text = (
        f"platform: {PLATFORMS[kind]}\ntopics:\n"
        "  /fixed: {type: std_msgs/msg/String, topic_dsm_size: 100000}\n"
        "  /sent: {type: std_msgs/msg/String, topic_dsm_size: 30000, transfer: async}\n"
        "nodes:\n"
    )
    for number, (name, endpoints) in enumerate(NODES.items(), start=1):
        (tmp_path / f"{name}.py").write_text(QUIET.format(endpoints=endpoints))
        text += f"  {name}: {{cluster: {number}, script: {name}.py}}\n"
    mapfile = tmp_path / "map.yaml"
    mapfile.write_text(text)
    predicted = {one.cluster: one.total for one in check(mapfile).memory if one.total}
    run = start(manycore_command("run", mapfile))

    def are_all_there() -> bool:
        try:
            return len(status(platform).endpoints) == ENDPOINTS
        except ManycoreError:  # the platform is not there yet
            return False

    wait_until(are_all_there, "all endpoints exist")

    def used() -> dict[int, int]:
        return {one.id: one.used_bytes for one in status(platform).clusters}

    wait_until(lambda: used() == predicted, f"{predicted} bytes are used")
    assert run.stop() == 0
