# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""Two hosts connected by a cable that delays packets and loses some."""

from __future__ import annotations

import ctypes
import fcntl
import heapq
import os
import random
import select
import struct
import subprocess
import threading
import time
from collections.abc import Iterator
from contextlib import ExitStack, contextmanager

from rmw_manycore_py.bench.hosts import ADDRESSES, Host

_TUNSETIFF, _TUN_WITHOUT_HEAD = 0x400454CA, 0x1001  # linux/if_tun.h
_CLONE_NEWNET = 0x40000000
_CABLE = b"cable"
_MAX_PACKET = 1 << 16


@contextmanager
def lossy_hosts(delay_s: float, loss: float) -> Iterator[tuple[Host, Host]]:
    """Create both hosts, and remove them at the end.

    :param delay_s: of each packet; reaching the other end and back takes twice as long.
    :param loss: part of the packets that is lost, the same ones each time.
    """
    names = [f"lossy{os.getpid()}{side}" for side in "ab"]
    with ExitStack() as ending:
        ends = []
        for name, address in zip(names, ADDRESSES, strict=True):
            _ip("netns", "add", name)
            ending.callback(_ip, "netns", "del", name)
            ends.append(_end_in(name))
            ending.callback(os.close, ends[-1])
            _ip("-n", name, "addr", "add", f"{address}/24", "dev", _CABLE.decode())
            for device in ("lo", _CABLE.decode()):
                _ip("-n", name, "link", "set", device, "up")
        ending.enter_context(_relay(ends, delay_s, loss))
        yield ["ip", "netns", "exec", names[0]], ["ip", "netns", "exec", names[1]]


def _end_in(name: str) -> int:
    """Create a network device there whose packets this process reads and writes; return it."""
    libc = ctypes.CDLL(None, use_errno=True)
    with open("/proc/thread-self/ns/net") as own, open(f"/run/netns/{name}") as other:
        for enter in (other, own):
            if libc.setns(enter.fileno(), _CLONE_NEWNET) != 0:
                raise OSError(ctypes.get_errno(), f"cannot enter {enter.name}")
            if enter is other:
                end = os.open("/dev/net/tun", os.O_RDWR | os.O_NONBLOCK)
                fcntl.ioctl(end, _TUNSETIFF, struct.pack("16sH22x", _CABLE, _TUN_WITHOUT_HEAD))
    return end


@contextmanager
def _relay(ends: list[int], delay_s: float, loss: float) -> Iterator[None]:
    """Pass packets on in a thread."""
    stop = os.eventfd(0)
    thread = threading.Thread(target=_pass_on, args=(ends, stop, delay_s, loss))
    thread.start()
    try:
        yield
    finally:
        os.eventfd_write(stop, 1)
        thread.join()
        os.close(stop)


def _pass_on(ends: list[int], stop: int, delay_s: float, loss: float) -> None:
    chance = random.Random(1)
    under_way: list[tuple[float, int, int, bytes]] = []  # due time, order, end, packet
    order = 0
    while True:
        wait_s = max(under_way[0][0] - time.monotonic(), 0) if under_way else None
        ready = select.select([*ends, stop], [], [], wait_s)[0]
        if stop in ready:
            return
        for end in ready:
            packet = os.read(end, _MAX_PACKET)
            if chance.random() >= loss:
                order += 1
                other = ends[1 - ends.index(end)]
                heapq.heappush(under_way, (time.monotonic() + delay_s, order, other, packet))
        while under_way and under_way[0][0] <= time.monotonic():
            os.write(under_way[0][2], heapq.heappop(under_way)[3])


def _ip(*words: str) -> None:
    subprocess.run(["ip", *words], check=True, capture_output=True)
