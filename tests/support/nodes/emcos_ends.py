# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""Ends of transfers that run until the other side ends: of this process, or of a peer."""

from __future__ import annotations

import itertools
import time
from collections.abc import Callable
from typing import Any

import numpy as np

from rmw_manycore_py import emcos
from support import TIMEOUT_S

SIZE = 1 << 16
WAITS = {"timeout_s": TIMEOUT_S}


def data(number: int) -> np.ndarray[Any, np.dtype[np.uint8]]:
    """Return what is sent: no part of it fits another number."""
    return np.full(SIZE, number % 251, np.uint8)


def check(found: Any) -> None:
    """Check that what came is whole."""
    array = np.frombuffer(found, np.uint8)
    assert array.size == SIZE
    assert (array == array[0]).all()


def move(session: emcos.SessionSender, number: int) -> None:
    session.buffer[:] = data(number)
    session.send(synchronous=True, **WAITS)


OPEN: dict[str, Callable[[str | None], Any]] = {
    "send": lambda platform: emcos.MessageSender("t", platform=platform, **WAITS),
    "receive": lambda platform: emcos.MessageReceiver("t", platform=platform, **WAITS),
    "move": lambda platform: emcos.SessionSender("t", SIZE, platform=platform, **WAITS),
    "take moved": lambda platform: emcos.SessionReceiver("t", SIZE, platform=platform, **WAITS),
    "put": lambda platform: emcos.SegmentWriter("t", platform=platform, **WAITS),
    "take": lambda platform: emcos.SegmentReader("t", platform=platform, **WAITS),
}
USE: dict[str, Callable[[Any, int], object]] = {
    "send": lambda end, number: end.send(data(number), synchronous=True, **WAITS),
    "receive": lambda end, number: check(end.receive(**WAITS).data),
    "move": move,
    "take moved": lambda end, number: check(end.receive(TIMEOUT_S)),
    "put": lambda end, number: end.put(data(number)),
    "take": lambda end, number: check(end.take(TIMEOUT_S)),
}
OTHER = {
    "send": "receive",
    "move": "take moved",
    "put": "take",
    "receive": "send",
    "take moved": "move",
    "take": "put",
}


def use(end: Any, role: str) -> None:
    """Send or receive until the other side ends, which it has to: PeerGoneError."""
    latest_s = time.monotonic() + TIMEOUT_S
    for number in itertools.count():
        USE[role](end, number)
        assert time.monotonic() < latest_s, "the other side goes on"


def run(role: str, platform: str | None = None) -> None:
    """Open an end, and use it until the other side ends."""
    with OPEN[role](platform) as end:
        use(end, role)
