# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""Round trips of messages in lent room, without ROS.

Usage: lent ping KIND BYTES WARM_UP ITERATIONS | lent pong KIND BYTES
"""

from __future__ import annotations

import json
import sys
import time

from rmw_manycore_py.bench.nodes.links import link

END = 0


def _ping(kind: str, size_bytes: int, warm_up: int, iterations: int) -> None:
    own = link(kind, "ping", "pong", size_bytes)
    print("ready", flush=True)
    sys.stdin.read()  # the other end is there
    samples_ns = []
    for number in range(1, warm_up + iterations + 1):
        begin_ns = time.perf_counter_ns()
        own.send(number)
        while own.receive() != number:
            pass
        samples_ns.append(time.perf_counter_ns() - begin_ns)
    own.send(END)
    own.receive()
    print(json.dumps({"samples_ns": samples_ns[warm_up:]}))


def _pong(kind: str, size_bytes: int) -> None:
    own = link(kind, "pong", "ping", size_bytes)
    print("ready", flush=True)
    number = -1
    while number != END:
        number = own.receive()
        own.send(number)
    sys.stdin.read()  # until the other end has the answer


def main() -> None:
    """Run one end."""
    role, kind, *numbers = sys.argv[1:]
    _ping(kind, *map(int, numbers)) if role == "ping" else _pong(kind, int(numbers[0]))


if __name__ == "__main__":
    main()
