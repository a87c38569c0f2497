# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""Round trips of plain zenoh between two sessions, without ROS.

Usage: zenoh_echo pong LOCATOR | ping LOCATOR BYTES WARM_UP ITERATIONS
"""

from __future__ import annotations

import json
import sys
import threading
import time

import zenoh
from zenoh.handlers import Callback

PING, PONG, END = "ping", "pong", b""
HELLO_PERIOD_S = 0.1


def session(side: str, locator: str) -> zenoh.Session:
    """Return a peer that listens there, or that connects to it."""
    config = zenoh.Config()
    config.insert_json5("mode", '"peer"')
    config.insert_json5("scouting/multicast/enabled", "false")
    # Namespaces of one machine share memory, hosts do not.
    config.insert_json5("transport/shared_memory/enabled", "false")
    config.insert_json5(f"{side}/endpoints", json.dumps([locator]))
    config.insert_json5("connect/timeout_ms", "-1")
    return zenoh.open(config)


def pong(locator: str) -> None:
    """Return every message until an empty one arrives."""
    ended = threading.Event()
    with session("listen", locator) as peer:
        publisher = peer.declare_publisher(PONG)

        def heard(sample: zenoh.Sample) -> None:
            if sample.payload == zenoh.ZBytes(END):
                ended.set()
            else:
                publisher.put(sample.payload)

        peer.declare_subscriber(PING, Callback(heard, indirect=False))
        ended.wait()


def ping(locator: str, size_bytes: int, warm_up: int, iterations: int) -> None:
    """Measure the round trips and print them."""
    answered = threading.Semaphore(0)
    with session("connect", locator) as peer:
        peer.declare_subscriber(PONG, Callback(lambda _: answered.release(), indirect=False))
        publisher = peer.declare_publisher(PING, congestion_control=zenoh.CongestionControl.BLOCK)
        message = bytes(size_bytes)
        while not publisher.matching_status.matching:
            time.sleep(HELLO_PERIOD_S)
        samples_ns = []
        for _ in range(warm_up + iterations):
            start_ns = time.monotonic_ns()
            publisher.put(message)
            answered.acquire()
            samples_ns.append(time.monotonic_ns() - start_ns)
        publisher.put(END)
    print(json.dumps({"samples_ns": samples_ns[warm_up:]}))


if __name__ == "__main__":
    side, where, *numbers = sys.argv[1:]
    if side == "pong":
        pong(where)
    else:
        ping(where, *map(int, numbers))
