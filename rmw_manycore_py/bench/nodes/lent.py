# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""Round trips of messages in lent room, without ROS.

Usage: lent ping KIND BYTES WARM_UP ITERATIONS | lent pong KIND BYTES
"""

from __future__ import annotations

import json
import sys
import time

from rmw_manycore_py.bench.nodes.links import receiver, sender

END = 0


def _ping(kind: str, size_bytes: int, warm_up: int, iterations: int) -> None:
    to, back = sender(kind, "ping", size_bytes), receiver(kind, "pong")
    print("ready", flush=True)
    sys.stdin.read()  # the other end is there
    samples_ns = []
    for number in range(1, warm_up + iterations + 1):
        begin_ns = time.perf_counter_ns()
        to.send(number)
        while back.receive() != number:
            pass
        samples_ns.append(time.perf_counter_ns() - begin_ns)
    to.send(END)
    back.receive()
    print(json.dumps({"samples_ns": samples_ns[warm_up:]}))


def _pong(kind: str, size_bytes: int) -> None:
    back, to = sender(kind, "pong", size_bytes), receiver(kind, "ping")
    print("ready", flush=True)
    number = -1
    while number != END:
        number = to.receive()
        back.send(number)
    sys.stdin.read()  # until the other end has the answer


def main() -> None:
    """Run one end."""
    role, kind, *numbers = sys.argv[1:]
    _ping(kind, *map(int, numbers)) if role == "ping" else _pong(kind, int(numbers[0]))


if __name__ == "__main__":
    main()
