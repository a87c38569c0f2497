# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""Packets that enter a network namespace are counted; packets within it are not."""

from __future__ import annotations

import os
import socket
import subprocess
from subprocess import PIPE

import pytest

from rmw_manycore_py.errors import ManycoreError
from rmw_manycore_py.papers.roslite2.laptop.network_namespace import entering, packets_received
from support import wait_until

pytestmark = pytest.mark.unit

PACKETS = 20
SENDER = "10.78.0.1"
RECEIVER = "10.78.0.2"


@pytest.fixture
def namespace():
    """Yield the name of a namespace that a cable leads to."""
    name, cable = f"mc{os.getpid()}", f"mc{os.getpid()}c"
    try:
        ip("netns", "add", name)
    except subprocess.CalledProcessError:
        pytest.skip("network namespaces need root")
    ip("link", "add", cable, "type", "veth", "peer", "name", "cable", "netns", name)
    ip("addr", "add", f"{SENDER}/30", "dev", cable)
    ip("link", "set", cable, "up")
    ip("-n", name, "addr", "add", f"{RECEIVER}/30", "dev", "cable")
    for link in ("cable", "lo"):
        ip("-n", name, "link", "set", link, "up")
    yield name
    ip("netns", "delete", name)


def ip(*words: str) -> None:
    subprocess.run(["ip", *words], check=True, capture_output=True)


def test_packets_from_outside_are_counted(namespace):
    with (
        subprocess.Popen(
            [*entering(namespace), "cat"], bufsize=0, stdin=PIPE, stdout=PIPE
        ) as inside,
        socket.socket(socket.AF_INET, socket.SOCK_DGRAM) as sender,
    ):
        inside.stdin.write(b"!")
        assert inside.stdout.read(1) == b"!"  # from now on it is in the namespace
        before = packets_received(inside.pid)
        for _ in range(PACKETS):
            sender.sendto(b"scan", (RECEIVER, 9))
        counted = lambda: packets_received(inside.pid) >= before + PACKETS  # noqa: E731
        wait_until(counted, "what the kernel has not passed on yet is counted, too")
        inside.stdin.close()
        inside.wait()
    assert packets_received(inside.pid) is None


def test_a_namespace_that_is_not_there():
    with pytest.raises(ManycoreError, match="found 'nowhere'; make it: ip netns add nowhere"):
        entering("nowhere")


def test_without_a_namespace_a_command_stays_as_it_is():
    assert entering(None) == []
