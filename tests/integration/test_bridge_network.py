# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""The platform and its listeners on two hosts (network namespaces), with large messages."""

from __future__ import annotations

import re
import socket
import subprocess
import sys
import threading
import time
from collections.abc import Iterator
from typing import Any

import pytest

from rmw_manycore_py.bench.hosts import NETWORK, Host, can_have_hosts, two_hosts
from support import IS_MANYCORE, MAPFILES, wait_until
from support.nodes.bridging import OUTSIDE
from support.nodes.ros import announce, peer_node, spin_until, type_of
from support.processes.commands import example_command, manycore_command, peer_command

pytestmark = [
    pytest.mark.integration,
    pytest.mark.skipif(not IS_MANYCORE, reason="the bridge is part of rmw_manycore"),
]

HEARD = "I heard: 'Hello World"
DEPTH = 1000  # all messages: a process without CPU for a while loses none of them
_RTPS_MAGIC = b"RTPS"
_PREFIX = slice(8, 20)  # of a participant's GUID, in the header of an RTPS message
_ETH_P_ALL = 3


@pytest.fixture
def hosts() -> Iterator[tuple[Host, Host]]:
    """Yield two hosts, each a network namespace, with a cable between them."""
    if not can_have_hosts():
        pytest.skip("network namespaces need root")
    with two_hosts() as both:
        yield both


def show_participants() -> None:
    """Print the GUID prefix of each DDS participant that packets arrive from."""
    seen = set()
    with socket.socket(socket.AF_PACKET, socket.SOCK_DGRAM, socket.htons(_ETH_P_ALL)) as cable:
        cable.bind(("cable", 0))
        announce("sniffing")
        while True:
            packet, address = cable.recvfrom(65536)
            at = packet.find(_RTPS_MAGIC)
            if at < 0 or address[2] == socket.PACKET_OUTGOING:
                continue
            prefix = packet[at:][_PREFIX].hex()
            if prefix not in seen:
                seen.add(prefix)
                announce(f"participant {prefix}")


def test_a_missing_network_is_reported(start) -> None:
    alone = ["unshare", "--net"]
    if subprocess.run([*alone, "true"], capture_output=True).returncode != 0:
        pytest.skip("a network namespace needs root")
    run = start([*alone, *manycore_command("run", MAPFILES / "talker_listener.yaml")])
    run.wait_for(r"^\(bridge \w+\) +\| no network interface is up")
    run.wait_for(rf"^listener .*{HEARD}")  # the platform needs none


@pytest.mark.needs("ip")
def test_only_the_bridge_speaks_to_another_host(start, platform, hosts) -> None:
    here, there = hosts
    sniffer = start([*there, *peer_command(show_participants)])
    sniffer.wait_for("^sniffing$")
    mapfile = MAPFILES / "talker_listener.yaml"
    run = start([*here, *map(str, manycore_command("run", mapfile))], **NETWORK)
    run.wait_for(HEARD)
    more = [start([*here, *example_command("listener")], cluster=3, **NETWORK) for _ in range(3)]
    listener = start([*there, *example_command("listener")], **OUTSIDE, **NETWORK)
    listener.wait_for(HEARD)
    for node in more:
        node.wait_for(HEARD)
    for _ in range(2):  # the inward process may start last
        sniffer.wait_for("^participant")
    for _ in range(4):
        listener.wait_for(HEARD)
    participants = {line for line in sniffer.lines if line.startswith("participant")}
    assert len(participants) == 2  # the inward and the outward process, for five nodes inside
    assert run.is_running()


def send_large(topic: str, type_name: str, size: int, rate_hz: int, count: int) -> None:
    """Publish empty messages until a line of input arrives, then large ones at their rate."""
    may_send = threading.Event()

    def listen() -> None:
        sys.stdin.readline()
        may_send.set()

    with peer_node("camera") as node:
        message = type_of(type_name)()
        message.header.frame_id = "empty"
        publisher = node.create_publisher(type(message), topic, DEPTH)
        threading.Thread(target=listen, daemon=True).start()
        while not may_send.wait(0.1):
            publisher.publish(message)
        message.data = bytes(size)
        start_s = time.monotonic()
        for number in range(count):
            time.sleep(max(start_s + number / rate_hz - time.monotonic(), 0))
            message.header.frame_id = str(number)
            publisher.publish(message)
        spin_until(node, lambda: False, 1e6)


def show_large(topic: str, type_name: str) -> None:
    """Print the id of each message."""
    with peer_node("viewer") as node:

        def heard(message: Any) -> None:
            announce(f"seen {message.header.frame_id}")

        node.create_subscription(type_of(type_name), topic, heard, DEPTH)
        spin_until(node, lambda: False, 1e6)


@pytest.mark.parametrize(
    ("direction", "type_name", "size", "rate_hz"),
    [
        ("inward", "sensor_msgs/msg/PointCloud2", 8_000_000, 10),
        ("outward", "sensor_msgs/msg/Image", 6_000_000, 30),
    ],
)
def test_large_messages_arrive_all(bridge, direction, type_name, size, rate_hz) -> None:
    count = 3 * rate_hz
    bridge.run(bridge.route(direction, "/large", type_name, qos={"depth": DEPTH}))
    source, target = bridge.outside, bridge.inside
    if direction == "outward":
        source, target = target, source
    viewer = target(show_large, "/large", type_name)
    camera = source(send_large, "/large", type_name, size, rate_hz, count)
    viewer.wait_for("^seen empty$")  # discovery is complete
    camera.say("go")
    for number in range(count):
        viewer.wait_for(f"^seen {number}$")
    numbers = re.findall(r"^seen (\d+)$", viewer.output, re.MULTILINE)
    assert [int(number) for number in numbers] == list(range(count))
    wait_until(lambda: bridge.row(direction, "/large")["messages"] > count, "all are counted")
    row = bridge.row(direction, "/large")
    assert (row["lost"], row["refused"]) == (0, 0)
