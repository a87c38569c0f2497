# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""Nodes in separate PID namespaces on one /dev/shm, like containers with `--ipc=host`."""

from __future__ import annotations

import os
import time
from contextlib import suppress
from pathlib import Path

import pytest
import rclpy
from std_msgs.msg import String

from support import IS_MANYCORE, wait_until
from support.nodes.ros import announce, peer_node, spin_until
from support.processes.commands import example_command, peer_command
from support.processes.inspection import cpu_time_s, kill, receive_threads_of

pytestmark = [
    pytest.mark.integration,
    pytest.mark.needs("unshare"),
    pytest.mark.skipif(not IS_MANYCORE, reason="looks at rmw_manycore's members"),
]

WATCHED_S = 2.0  # how long idle processes are measured
IDLE_CPU_S = 0.06  # 3 % for all together; a process that polls a pid uses more


def in_namespace(*command: str) -> list[str]:
    """Return a command that runs another one as the first process of a PID namespace."""
    user = [] if os.geteuid() == 0 else ["--user", "--map-current-user"]
    return ["unshare", *user, "--pid", "--fork", "--kill-child", "--mount-proc", *command]


def first_process_of(namespace: int) -> int:
    """Return the pid, in this namespace, of the process that `unshare` runs."""
    children = Path(f"/proc/{namespace}/task/{namespace}/children").read_text().split()
    return int(children[0])


def members(platform: str) -> set[int]:
    """Return the registry slots of a platform's members."""
    from rmw_manycore_py.native._transport import Platform

    with Platform(platform) as seen:
        return {process.slot for process in seen.processes()}


def cpu_used_by(pids: list[int]) -> float:
    """Return the CPU time that processes use during the measurement."""
    before_s = sum(map(cpu_time_s, pids))
    time.sleep(WATCHED_S)
    return sum(map(cpu_time_s, pids)) - before_s


def start_outside(start):
    """Return a node in the initial namespace; its receive thread outlives those in namespaces."""
    program = start(example_command("talker", "--ros-args", "-r", "chatter:=unheard"), 3)
    program.wait_for("Publishing")
    return program


@pytest.fixture
def outside(start):
    return start_outside(start)


@pytest.fixture
def talker(start, outside):
    """Return a talker in its own namespace, in cluster 1."""
    program = start(in_namespace(*example_command("talker")), 1)
    program.wait_for("Publishing")
    return program


@pytest.mark.parametrize("cluster", [1, 2])
def test_nodes_of_two_namespaces_talk(platform, start, talker, cluster):
    listener = start(in_namespace(*example_command("listener")), cluster)
    listener.wait_for("I heard")


@pytest.mark.parametrize("cluster", [1, 2])
def test_a_node_killed_in_its_namespace_is_reaped(platform, start, talker, cluster):
    """If the talker is alone in cluster 1, the receive thread that it started dies with it."""
    listener = start(example_command("listener"), cluster)
    listener.wait_for("I heard")
    assert len(members(platform)) == 3
    kill(first_process_of(talker.pid))
    wait_until(lambda: len(members(platform)) == 2, "the talker is no member any more")
    late = start(in_namespace(*example_command("talker")), 1)
    late.wait_for("Publishing")
    listener.skip_output()
    listener.wait_for("I heard")


def test_a_node_with_the_pid_of_a_watched_one_is_reaped(platform, start):
    """The first process of each namespace has pid 1; the first reaper watches its own only."""
    talker = start(in_namespace(*example_command("talker")), 1)
    talker.wait_for("Publishing")
    listener = start(in_namespace(*example_command("listener")), 1)
    listener.wait_for("I heard")
    assert len(members(platform)) == 2
    kill(first_process_of(listener.pid))
    wait_until(lambda: len(members(platform)) == 1, "the listener is no member any more")
    start_outside(start)  # only now: it would have reaped as well


def test_the_discovery_range_off_keeps_a_namespace_alone(start):
    """Both processes have pid 1, and share a domain."""
    off = {"ROS_AUTOMATIC_DISCOVERY_RANGE": "OFF"}
    for name in ("one", "two"):
        start(in_namespace(*peer_command(show_nodes, name)), **off).wait_for(f"^1 {name}$")


def show_nodes(name: str) -> None:
    """Announce pid and nodes once messages arrive from a publisher of the own process."""
    with peer_node(name) as node:
        heard: list[String] = []
        node.create_subscription(String, "chatter", heard.append, 10)
        publisher = node.create_publisher(String, "chatter", 10)
        publisher.publish(String())
        spin_until(node, lambda: heard)
        announce(f"{os.getpid()} {' '.join(node.get_node_names())}")
        rclpy.spin(node)


def test_watching_another_namespace_costs_nothing(platform, start, talker):
    """A pid of another namespace means nothing here, so receive threads must not poll it."""
    watcher = start([*in_namespace(*example_command("listener")), "--ros-args", "-r", "chatter:=x"])
    wait_until(lambda: len(members(platform)) == 3, "all are members")
    wait_until(lambda: receive_threads_of(platform), "there is a receive thread")
    kill(first_process_of(talker.pid))
    wait_until(lambda: len(members(platform)) == 2, "the talker is no member any more")

    def idles() -> bool:
        receive_threads = receive_threads_of(platform)
        with suppress(FileNotFoundError):  # one may just be ending with the talker's namespace
            used_s = cpu_used_by([first_process_of(watcher.pid), *receive_threads])
            return bool(receive_threads) and used_s < IDLE_CPU_S
        return False

    wait_until(idles, "what had to start has started, and idles")
