# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""Many nodes in a process: a single message circulates from node to node.

Usage: ring EXECUTOR NODES WARM_UP LAPS PROCESSES PROCESS

With the executor `each`, every node has a SingleThreadedExecutor in a thread of its own. The nodes
are divided among the processes, so that of two each message comes from the other one. Process 0
measures; others run until they are killed.
"""

from __future__ import annotations

import itertools
import json
import sys
import threading
import time
from typing import Any

import rclpy
from rclpy.executors import MultiThreadedExecutor, SingleThreadedExecutor
from rclpy.experimental.events_executor import EventsExecutor
from rclpy.node import Node
from std_msgs.msg import UInt64

THREADS = 16
LOOK_S = 0.02
TIMEOUT_S = 1.0
EXECUTORS = {
    "single": SingleThreadedExecutor,
    "multi": lambda: MultiThreadedExecutor(num_threads=THREADS),
    "events": EventsExecutor,
    "each": SingleThreadedExecutor,
}


class Link(Node):  # type: ignore[misc]
    """Forwards each message; the first link times the laps, and keeps the last message."""

    def __init__(self, number: int, of: int, laps: int) -> None:
        super().__init__(f"link_{number}")
        self._is_first, self._laps = number == 0, laps
        self.lap_ends_ns: list[int] = []
        self.lap_cpu_ns: list[int] = []
        self.done = threading.Event()
        self.next = self.create_publisher(UInt64, f"/ring_{(number + 1) % of}", 1)
        self._previous = self.create_subscription(UInt64, f"/ring_{number}", self._hear, 1)

    def _hear(self, message: UInt64) -> None:
        if self._is_first:
            self.lap_ends_ns.append(time.monotonic_ns())
            self.lap_cpu_ns.append(time.process_time_ns())
            if len(self.lap_ends_ns) > self._laps:
                self.done.set()
                return
        self.next.publish(message)


def _executors(kind: str, links: list[Link]) -> list[Any]:
    """Return the executors of all links: one, or one each."""
    if kind != "each":
        shared = EXECUTORS[kind]()
        for link in links:
            shared.add_node(link)
        return [shared]
    executors = [EXECUTORS[kind]() for _ in links]
    for executor, link in zip(executors, links, strict=True):
        executor.add_node(link)
    return executors


def _spin(executor: Any, done: threading.Event) -> None:
    # Do not use spin(): that of EventsExecutor misses messages, with any middleware.
    while not done.is_set():
        executor.spin_once(TIMEOUT_S)


def main() -> None:
    """Measure the laps; print the time of one hop, and the CPU time of a message here."""
    kind, *numbers = sys.argv[1:]
    count, warm_up, laps, processes, process = map(int, numbers)
    rclpy.init()
    numbers_here = range(process, count, processes)
    links = [Link(number, count, warm_up + laps) for number in numbers_here]
    while any(link.next.get_subscription_count() == 0 for link in links):
        time.sleep(LOOK_S)
    executors = _executors(kind, links)
    done = links[0].done
    spinners = [threading.Thread(target=_spin, args=(each, done)) for each in executors]
    for spinner in spinners:
        spinner.start()
    if process == 0:
        links[0].next.publish(UInt64())
    done.wait()
    for spinner, executor in zip(spinners, executors, strict=True):
        spinner.join()
        executor.shutdown()
    hops, cpu = (
        [(end - start) / nodes for start, end in itertools.pairwise(times_ns[warm_up:])]
        for times_ns, nodes in (
            (links[0].lap_ends_ns, count),
            (links[0].lap_cpu_ns, len(links)),
        )
    )
    print(json.dumps({"samples_ns": hops, "cpu_ns": cpu}))
    for link in links:
        link.destroy_node()
    rclpy.shutdown()


if __name__ == "__main__":
    main()
