# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""Messages on many topics, each at a rate, without ROS: one source, and sinks of all topics.

Usage: topics source KIND TOPICS BYTES RATE_HZ MESSAGES | topics sink KIND TOPICS

The number of a message is the time when it was sent. All topics have theirs one after the other.
"""

from __future__ import annotations

import json
import sys
import time

from rmw_manycore_py.bench.nodes.links import receiver, sender

END = 0


def _name(number: int) -> str:
    return f"topic_{number}"


def _source(kind: str, topics: int, size_bytes: int, rate_hz: int, messages: int) -> None:
    senders = [sender(kind, _name(i), size_bytes) for i in range(topics)]
    print("ready", flush=True)
    sys.stdin.read()  # the sinks are there
    due_s = time.monotonic()
    for _ in range(messages):
        for one in senders:
            one.send(time.monotonic_ns())
        due_s += 1 / rate_hz
        time.sleep(max(due_s - time.monotonic(), 0))
    for one in senders:
        one.send(END)


def _sink(kind: str, topics: int) -> None:
    receivers = [receiver(kind, _name(i)) for i in range(topics)]
    print("ready", flush=True)
    samples_ns = []
    has_ended = False
    while not has_ended:
        for one in receivers:
            if (sent_ns := one.receive()) != END:
                samples_ns.append(time.monotonic_ns() - sent_ns)
            has_ended = has_ended or sent_ns == END
    print(json.dumps({"samples_ns": samples_ns}))


def main() -> None:
    """Run the source or a sink."""
    role, kind, *numbers = sys.argv[1:]
    (_source if role == "source" else _sink)(kind, *map(int, numbers))


if __name__ == "__main__":
    main()
