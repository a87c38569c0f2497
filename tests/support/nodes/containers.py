# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""Nodes as the only process of a PID namespace each, so all their main threads are number 1."""

from __future__ import annotations

import ctypes
import os
import random
import signal
import time
import traceback
from collections.abc import Callable

from std_msgs.msg import UInt8MultiArray

from support.nodes.load import PR_SET_PDEATHSIG
from support.nodes.ros import announce, peer_node

CLONE_NEWPID = 0x20000000  # <sched.h>
ENDPOINTS = 40  # of each kind and node
LONGEST_PAUSE_S = 0.008
KILLED = (0, -signal.SIGKILL)


class Container:
    """A function that runs as the first process of a PID namespace."""

    def __init__(self, function: Callable[[], None]) -> None:
        receiver, sender = os.pipe()
        self._outer = os.fork()
        if self._outer == 0:
            os._exit(_contain(function, sender))
        os.close(sender)
        with os.fdopen(receiver) as pipe:
            self._inner = int(pipe.read())

    def kill(self) -> bool:
        """Kill the process; return whether it was still alive, as it should."""
        os.kill(self._inner, signal.SIGKILL)
        return os.waitstatus_to_exitcode(os.waitpid(self._outer, 0)[1]) == 0


def _contain(function: Callable[[], None], sender: int) -> int:
    libc = ctypes.CDLL(None, use_errno=True)
    libc.prctl(PR_SET_PDEATHSIG, signal.SIGKILL)  # no orphans if a test fails
    if libc.unshare(CLONE_NEWPID) != 0:
        raise OSError(ctypes.get_errno(), "cannot make a PID namespace")
    inner = os.fork()
    if inner == 0:
        os.close(sender)
        try:
            function()
        except BaseException:
            announce(f"failed: {traceback.format_exc()}")
        os._exit(1)
    os.write(sender, str(inner).encode())
    os.close(sender)
    return 0 if os.waitstatus_to_exitcode(os.waitpid(inner, 0)[1]) in KILLED else 1


def create_many() -> None:
    with peer_node(f"node_{random.randrange(1 << 30)}") as node:
        for number in range(ENDPOINTS):
            node.create_publisher(UInt8MultiArray, f"topic_{number}", 10)
            node.create_subscription(UInt8MultiArray, f"topic_{number}", print, 10)
        while True:
            signal.pause()


def bring_up(rounds: int, containers: int, seed: int) -> None:
    """Start containers side by side, and kill one while the others come up, again and again."""
    random.seed(seed)
    failures = 0
    running = [Container(create_many) for _ in range(containers)]
    for number in range(rounds):
        first, second = number % containers, (number + 1) % containers
        for index in (first, second):
            failures += not running[index].kill()
        for index in (first, second):
            running[index] = Container(create_many)
        time.sleep(random.uniform(0, LONGEST_PAUSE_S))  # the random moment
        failures += not running[first].kill()
        running[first] = Container(create_many)
        time.sleep(random.uniform(0, 2 * LONGEST_PAUSE_S))  # the random moment
    failures += sum(not container.kill() for container in running)
    announce(f"{rounds} rounds, {failures} failures")
