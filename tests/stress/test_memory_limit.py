# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""The kernel kills nodes whose cgroup has no memory left; the others go on.

It does so where a page is needed: in the middle of joining, of growing a topic DSM, of writing a
message into it. Pages of shared memory belong to the cgroup whose process touched them first.
"""

from __future__ import annotations

import os
import random
import signal
import sys
from pathlib import Path

import pytest
from std_msgs.msg import UInt8MultiArray

from support import IS_MANYCORE, KILLS, wait_until
from support.nodes.load import TOPIC, fork
from support.nodes.payload import make_message
from support.nodes.ros import announce, peer_node
from support.processes.commands import peer_command
from support.processes.memory_cgroup import NoMemoryCgroupError, memory_cgroup

pytestmark = pytest.mark.skipif(not IS_MANYCORE, reason="about the memory of rmw_manycore")

MIB = 1 << 20
LIMITS_BYTES = (4 * MIB, 64 * MIB)  # from an end while the node joins to one while it grows
SIZES_BYTES = (1000, 10_000, 100_000)
CLUSTERS = 2


def grow_until_killed(procs: str) -> None:
    """Publish larger and larger messages on more and more topics, and small ones to the others."""
    Path(procs).write_text("0")
    with peer_node(f"growing_{os.getpid()}") as node:
        shared = node.create_publisher(UInt8MultiArray, TOPIC, 10)
        kept = []
        while True:
            name = f"growing_{os.getpid()}_{len(kept)}"
            kept.append(node.create_publisher(UInt8MultiArray, name, 10))
            for size_bytes in SIZES_BYTES:
                kept[-1].publish(make_message(os.getpid(), 1, size_bytes))
            shared.publish(make_message(os.getpid(), len(kept), SIZES_BYTES[0]))


def breed_in_cgroups() -> None:
    """Fork a growing node for each line of input, "CLUSTER PROCS"."""
    signal.signal(signal.SIGCHLD, signal.SIG_IGN)
    announce("ready")
    for line in sys.stdin:
        cluster, procs = line.split()
        fork(lambda procs=procs: grow_until_killed(procs), cluster)


@pytest.fixture(autouse=True)
def cgroups() -> None:
    try:
        with memory_cgroup(MIB):
            pass
    except NoMemoryCgroupError as error:
        pytest.skip(str(error))


def is_running(pid: int) -> bool:
    try:
        os.kill(pid, 0)
    except ProcessLookupError:
        return False
    return True


def test_nodes_without_memory_are_killed(start, load, graves) -> None:
    nursery = start(peer_command(breed_in_cgroups))
    nursery.wait_for("ready")
    for number in range(KILLS // 20):
        with memory_cgroup(random.randint(*LIMITS_BYTES)) as cgroup:
            nursery.say(f"{random.randint(1, CLUSTERS)} {cgroup.procs}")
            victim = int(nursery.wait_for(r"born (\d+)").group(1))
            wait_until(lambda pid=victim: not is_running(pid), "the victim has ended")
            graves.note(victim)
            assert cgroup.kills() == 1, nursery
        graves.assert_reclaimed()
        if number % 10 == 9:
            load.assert_it_goes_on_unharmed()
    graves.assert_survived_by(load, nursery)
