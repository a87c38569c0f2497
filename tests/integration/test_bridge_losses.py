# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""Lost messages and dropped datagrams that the bridge reports."""

from __future__ import annotations

import ctypes
import os
import re
import signal
import socket
import subprocess
from contextlib import ExitStack, suppress
from pathlib import Path

import pytest

from rmw_manycore_bridge.datagrams import receive_buffer_errors, socket_drops
from rmw_manycore_py.routes.plan import Plan
from rmw_manycore_py.routes.route import arranged
from support import IS_MANYCORE, REPOSITORY, wait_until
from support.processes.commands import manycore_command
from support.processes.platforms import environment

pytestmark = [
    pytest.mark.integration,
    pytest.mark.skipif(not IS_MANYCORE, reason="the bridge is part of rmw_manycore"),
]

GUIDE = REPOSITORY / "docs" / "how-to" / "socket_buffers.md"
_SYS_PIDFD_GETFD = 438  # of x86-64
PORTS = 3  # sockets of a participant: multicast and unicast discovery, and messages
DATAGRAMS = 40
DATAGRAM = bytes(1000)
SMALL_BUFFER_BYTES = 4096


@pytest.fixture
def full_socket():
    """Yield a socket of this process that has dropped datagrams for lack of buffer space."""
    with ExitStack() as stack:
        receiver, sender = (
            stack.enter_context(socket.socket(socket.AF_INET, socket.SOCK_DGRAM)) for _ in "ab"
        )
        receiver.setsockopt(socket.SOL_SOCKET, socket.SO_RCVBUF, SMALL_BUFFER_BYTES)
        receiver.bind(("127.0.0.1", 0))
        for _ in range(DATAGRAMS):
            sender.sendto(DATAGRAM, receiver.getsockname())
        yield receiver


def received(receiver: socket.socket) -> int:
    count = 0
    receiver.setblocking(False)
    while True:
        try:
            receiver.recv(len(DATAGRAM))
        except BlockingIOError:
            return count
        count += 1


def test_datagrams_of_a_full_socket_are_counted(full_socket) -> None:
    drops = socket_drops(os.getpid())
    assert drops == DATAGRAMS - received(full_socket)
    assert drops > 0
    assert (receive_buffer_errors(os.getpid()) or 0) >= drops


def test_another_process_s_datagrams_are_not_the_bridge_s(full_socket) -> None:
    with subprocess.Popen(["sleep", "1000"]) as other:
        assert socket_drops(other.pid) == 0
        assert (receive_buffer_errors(other.pid) or 0) > 0  # of the network namespace
        other.kill()


def test_a_process_that_is_gone_has_no_counts() -> None:
    with subprocess.Popen(["true"]) as other:
        other.wait()
    assert socket_drops(other.pid) is None
    assert receive_buffer_errors(other.pid) is None


def test_datagrams_that_a_stopped_bridge_drops_are_in_its_status(bridge) -> None:
    (process,) = bridge.run(bridge.route("inward", "/chatter")).values()
    wait_until(lambda: ports_of(process.pid), "it has joined the domain")
    wait_until(lambda: bridge.row("inward", "/chatter"), "it counts")
    process.signal(signal.SIGSTOP)  # the threads that empty its sockets are stopped
    ports = ports_of(process.pid)
    with socket.socket(socket.AF_INET, socket.SOCK_DGRAM) as sender:

        def is_full() -> bool:
            for port in ports:
                sender.sendto(bytes(60_000), ("127.0.0.1", port))
            return bool(bridge.row("inward", "/chatter")["socket_drops"])

        wait_until(is_full, "a buffer is full")
    drops = bridge.row("inward", "/chatter")["socket_drops"]
    words = [str(word) for word in manycore_command("bridge", "status")]
    shown = subprocess.run(
        words, env=environment(bridge.platform), text=True, capture_output=True, check=True
    ).stdout
    assert f"{drops} of the bridge" in shown
    process.signal(signal.SIGCONT)


def sockets_of(pid: int) -> dict[int, str]:
    """Return the sockets of a process by their file descriptors."""
    found = {}
    for entry in os.scandir(f"/proc/{pid}/fd"):
        with suppress(FileNotFoundError):  # closed meanwhile
            found[int(entry.name)] = os.readlink(entry.path)
    return {fd: link for fd, link in found.items() if link.startswith("socket:")}


def ports_of(pid: int) -> set[int]:
    """Return the port numbers of a process's UDP sockets."""
    links = sockets_of(pid).values()
    with open(f"/proc/{pid}/net/udp") as file:
        rows = [line.split() for line in file.readlines()[1:]]
    return {int(row[1].rpartition(":")[2], 16) for row in rows if f"socket:[{row[9]}]" in links}


@pytest.fixture
def profile(tmp_path: Path) -> Path:
    """The profile of the guide, as a file."""
    text = re.search(r"^```xml\n(.*?)^```$", GUIDE.read_text(), re.MULTILINE | re.DOTALL)[1]
    file = tmp_path / "large_buffers.xml"
    file.write_text(text)
    return file


def test_the_guide_s_profile_gives_the_bridge_larger_buffers(start, bridge, profile) -> None:
    asked = int(re.search(r"<receiveBufferSize>(\d+)<", profile.read_text())[1])
    allowed = int(Path("/proc/sys/net/core/rmem_max").read_text())
    plan = Plan(bridge.platform, arranged([bridge.route("inward", "/chatter")], 1))
    larger = bridge.run_one(plan, "inward", FASTRTPS_DEFAULT_PROFILES_FILE=str(profile))
    granted = 2 * min(asked, allowed)  # half of it is the kernel's overhead
    wait_until(lambda: granted in buffers_of(larger.pid), "it has joined the domain")


def test_without_a_profile_a_buffer_is_the_kernel_s_default(bridge) -> None:
    default = int(Path("/proc/sys/net/core/rmem_default").read_text())
    (process,) = bridge.run(bridge.route("inward", "/chatter")).values()
    wait_until(lambda: len(ports_of(process.pid)) >= PORTS, "it has joined the domain")
    assert buffers_of(process.pid) == {default}


def buffers_of(pid: int) -> set[int]:
    """Return the receive buffers of a process's UDP sockets, in bytes."""
    process, found = os.pidfd_open(pid), set()
    for number in sockets_of(pid):
        fd = ctypes.CDLL(None).syscall(_SYS_PIDFD_GETFD, process, number, 0)
        if fd < 0:
            continue
        with socket.socket(fileno=fd) as copy:
            if (copy.family, copy.type) == (socket.AF_INET, socket.SOCK_DGRAM):
                found.add(copy.getsockopt(socket.SOL_SOCKET, socket.SO_RCVBUF))
    os.close(process)
    return found
