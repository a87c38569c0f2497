# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""A hundred nodes at once, and a platform all of whose processes are killed."""

from __future__ import annotations

import os
import time

import pytest

from support import IS_MANYCORE, TIMEOUT_S, wait_until
from support.nodes.load import crowd, join_at_once
from support.processes.commands import example_command, peer_command
from support.processes.inspection import (
    cpu_time_s,
    has_receive_threads,
    is_asleep,
    kill,
    kill_all,
    processes_of,
)
from support.processes.platforms import leftovers

SIZE = int(os.environ.get("MANYCORE_TEST_CROWD", "100"))
IDLE_S = 3.0  # how long the idle crowd is measured
IDLE_CPU_S = 0.1  # for all hundred together: ten ticks of the kernel's accounting

needs_manycore = pytest.mark.skipif(not IS_MANYCORE, reason="looks at rmw_manycore's directory")


def test_a_crowd_is_matched_and_then_idle(start):
    """Every node hears every other one; afterwards none of them uses the CPU."""
    program = start(peer_command(crowd, SIZE))
    pids, done = set(), 0
    while done < SIZE or len(pids) < SIZE:
        match = program.wait_for(r"born (\d+)|heard all", timeout_s=4 * TIMEOUT_S)
        pids |= {int(match.group(1))} if match.group(1) else set()
        done += match.group(1) is None
    if IS_MANYCORE:
        for pid in pids:  # it may not have run since it printed the line
            wait_until(lambda pid=pid: is_asleep(pid), f"node {pid} has nothing to do")
        # What one of them still does late is over soon; idling must last.
        wait_until(lambda: cpu_used_by(pids) <= IDLE_CPU_S, "the crowd idles")
    for pid in pids:
        kill(pid)


@pytest.mark.parametrize(("size", "endpoints"), [(500, 0), (200, 5)])
def test_a_crowd_joins_at_one_moment(start, size, endpoints):
    """None waits until it gives up; how long it takes is measured by `manycore bench scale`."""
    program = start(peer_command(join_at_once, size, endpoints))
    for _ in range(size):
        program.wait_for(r"born \d+")
    program.say("go")
    for _ in range(size):
        program.wait_for("has joined")


def cpu_used_by(pids: set[int]) -> float:
    """Return the CPU time that processes use during the measurement."""
    before_s = sum(map(cpu_time_s, pids))
    time.sleep(IDLE_S)  # the time measured
    return sum(map(cpu_time_s, pids)) - before_s


@needs_manycore
def test_a_platform_that_was_killed_whole_starts_again(start, platform):
    for _ in range(5):
        nodes = [start(example_command("talker")), start(example_command("listener"), 2)]
        nodes[1].wait_for("I heard: 'Hello World")
        wait_until(lambda: has_receive_threads(platform), "both clusters have one")
        wait_until(lambda: len(processes_of(platform)) == 4, "two nodes and two receive threads")
        kill_all(platform)
    assert leftovers(platform), "files are left: no process removed them"
    listener = start(example_command("listener"), cluster=2)
    talker = start(example_command("talker"))
    listener.wait_for("I heard: 'Hello World")
    for node in (talker, listener):
        assert node.stop_node(), node
