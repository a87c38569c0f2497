# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""Requests and responses that the bridge cannot forward: callers get an error, others go on."""

from __future__ import annotations

from collections.abc import Iterator
from typing import Any

import pytest

from rmw_manycore_py.native import _transport
from support import IS_MANYCORE, TIMEOUT_S, wait_until
from support.nodes.bridging import Bridge
from support.nodes.ros import announce, peer_node, spin_until, type_of

pytestmark = [
    pytest.mark.integration,
    pytest.mark.skipif(not IS_MANYCORE, reason="the bridge is part of rmw_manycore"),
]

# Requests and responses of any size: `d` of the camera's info, and `status_message`.
SET_CAMERA = "sensor_msgs/srv/SetCameraInfo"
SMEM_BYTES, TOO_LARGE = 4 << 20, 8_000_000
DOES_NOT_FIT = r"^answer False bridge: a message of 8\d{6} bytes on '/camera' does not fit"


@pytest.fixture
def platform(platform) -> Iterator[str]:
    """Give the test's platform as little SMEM as a cluster of the MPPA3-80 has."""
    with _transport.Configurator(
        platform,
        clusters=1,
        cores_per_cluster=16,
        smem_bytes=SMEM_BYTES,
        host_cpu_of_receive_thread={},
        topics=[],
    ):
        yield platform


def serve_camera() -> None:
    """Serve SetCameraInfo; the response has as many bytes as the request's height."""
    with peer_node("server") as node:

        def answer(request: Any, response: Any) -> Any:
            response.success = True
            response.status_message = "x" * request.camera_info.height
            return response

        node.create_service(type_of(SET_CAMERA), "/camera", answer)
        # Fast DDS drops a response if it does not discover the client within 100 ms.
        wait_until(lambda: node.count_clients("/camera"), "the bridge's client is discovered")
        announce("serving")
        spin_until(node, lambda: False, 1e6)


def set_camera(*sizes: tuple[int, int]) -> None:
    """Call SetCameraInfo with requests and responses of these sizes in bytes."""
    with peer_node("caller") as node:
        request = type_of(SET_CAMERA).Request()
        client = node.create_client(type_of(SET_CAMERA), "/camera")
        assert client.wait_for_service(TIMEOUT_S)
        for request_bytes, reply_bytes in sizes:
            request.camera_info.d = [0.0] * (request_bytes // 8)
            request.camera_info.height = reply_bytes
            future = client.call_async(request)
            spin_until(node, future.done)
            announce(f"answer {future.result().success} {future.result().status_message}")


def still_works(bridge: Bridge, direction: Any, pid: int) -> None:
    """Check that one request was refused, one forwarded, and the bridge was not restarted."""
    wait_until(lambda: bridge.row(direction, "/camera")["messages"], "what was answered is counted")
    row = bridge.row(direction, "/camera")
    assert (row["pid"], row["alive"]) == (pid, True)
    assert (row["refused"], row["messages"], row["timed_out"]) == (1, 1, 0)


def test_a_request_that_does_not_fit(bridge) -> None:
    process = bridge.run(bridge.route("inward", "/camera", SET_CAMERA))["inward"]
    bridge.inside(serve_camera).wait_for("^serving$")
    caller = bridge.outside(set_camera, (TOO_LARGE, 0), (0, 3))
    caller.wait_for(DOES_NOT_FIT)
    caller.wait_for("^answer True xxx$")
    still_works(bridge, "inward", process.pid)


def test_a_reply_that_does_not_fit(bridge) -> None:
    process = bridge.run(bridge.route("outward", "/camera", SET_CAMERA))["outward"]
    bridge.outside(serve_camera).wait_for("^serving$")
    caller = bridge.inside(set_camera, (0, TOO_LARGE), (0, 3))
    caller.wait_for(DOES_NOT_FIT)
    caller.wait_for("^answer True xxx$")
    still_works(bridge, "outward", process.pid)


def ask_nonsense(platform: str) -> None:
    """Send one byte, which is no request of any type, and print the size of the response."""
    from rclpy.qos import qos_profile_services_default

    from rmw_manycore_bridge.fastdds.policies import from_rclpy

    with _transport.Process(platform) as process:
        endpoint = ("/camera", SET_CAMERA, from_rclpy(qos_profile_services_default))
        replies = process.subscription(*endpoint, role="reply")
        requests = process.publisher(*endpoint, role="request")
        seen = process.epoch()
        while not (requests.matched() and replies.matched()):
            process.wait(seen, 0.05)
            seen = process.epoch()
        requests.publish(b"?", client=replies.gid, number=1)
        while (reply := replies.claim()) is None:
            process.wait(seen, None)
            seen = process.epoch()
        announce(f"answer {b'bridge: ' in reply.data}")
        reply.release()


def test_a_request_that_cannot_be_read(bridge) -> None:
    process = bridge.run(bridge.route("outward", "/camera", SET_CAMERA))["outward"]
    bridge.outside(serve_camera).wait_for("^serving$")
    bridge.outside(ask_nonsense, bridge.platform).wait_for("^answer True$")
    bridge.inside(set_camera, (0, 3)).wait_for("^answer True xxx$")
    still_works(bridge, "outward", process.pid)
