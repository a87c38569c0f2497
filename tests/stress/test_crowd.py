# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""A hundred nodes at once, and a platform all of whose processes are killed."""

from __future__ import annotations

import os
import time

import pytest
from load import crowd
from processes import (
    cpu_time_s,
    has_receive_threads,
    is_asleep,
    kill,
    kill_all,
    processes_of,
)
from support import IS_MANYCORE, TIMEOUT_S, example_command, leftovers, peer_command, wait_until

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
        before = {pid: cpu_time_s(pid) for pid in pids}
        time.sleep(IDLE_S)  # the time measured
        used_s = sum(cpu_time_s(pid) - before[pid] for pid in pids)
        assert used_s <= IDLE_CPU_S
    for pid in pids:
        kill(pid)


@needs_manycore
def test_a_platform_that_was_killed_whole_starts_again(start, platform):
    for _ in range(5):
        nodes = [start(example_command("talker")), start(example_command("listener"), 2)]
        nodes[1].wait_for("I heard: 'Hello World")
        wait_until(lambda: has_receive_threads(platform), "both clusters have one")
        pids = processes_of(platform)
        assert len(pids) == 4, pids  # two nodes and two receive threads
        kill_all(platform)
    assert leftovers(platform), "files are left: no process removed them"
    listener = start(example_command("listener"), cluster=2)
    talker = start(example_command("talker"))
    listener.wait_for("I heard: 'Hello World")
    for node in (talker, listener):
        assert node.stop_node(), node
