# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""Cost of many idle nodes."""

from __future__ import annotations

import time
from collections.abc import Iterable, Iterator, Sequence
from dataclasses import replace
from pathlib import Path

from rmw_manycore_py.bench.contenders import FAST_DDS, INSIDE, Middleware, manycore
from rmw_manycore_py.bench.question import Question, Run
from rmw_manycore_py.bench.session import Session
from rmw_manycore_py.bench.summary import Goal, Result

CLUSTERS = 5
WINDOW_S = 10.0
# Fast DDS processes discover each other pairwise: a hundred would take minutes.
FAST_DDS_NODES = 20


def question(nodes: int) -> Question:
    """Return the question for this many nodes."""
    own = tuple(_spread(manycore("inside", wait), nodes) for wait in ("block", "adaptive"))
    counts = {**dict.fromkeys(own, nodes), FAST_DDS: min(nodes, FAST_DDS_NODES)}

    def measure(run: Run) -> list[Result]:
        results = []
        for middleware, count in counts.items():
            if run.wants(middleware.name):
                run.note(f"{count} idle nodes: {middleware.name}")
                results += _watch(run, middleware, count)
        return results

    return Question(
        "idle",
        measure,
        tuple(Goal(name(nodes), each.name, "within", 0) for name in (cpu, wakes) for each in own),
        f"nodes on both CPUs in turn, over {CLUSTERS} clusters, receive threads included",
    )


def cpu(nodes: int) -> str:
    """Return the name of the question for CPU time."""
    return f"{nodes} idle nodes, CPU"


def wakes(nodes: int) -> str:
    """Return the name of the question for wake-ups."""
    return f"{nodes} idle nodes, wake-ups"


def _spread(middleware: Middleware, nodes: int) -> Middleware:
    name = middleware.name.replace(INSIDE.name.split()[1], f"in {CLUSTERS} clusters")
    clusters = tuple(party % CLUSTERS + 1 for party in range(nodes))
    return replace(middleware, name=name, clusters=clusters)


def _watch(run: Run, middleware: Middleware, nodes: int) -> list[Result]:
    """Return CPU time in ms and wake-ups, both per second, summed over all processes."""
    window_s = WINDOW_S * max(run.share, 0.1)
    with Session(middleware, run.cpus) as session:
        processes = [
            session.native("idle_node", party, name=f"idle_{party}") for party in range(nodes)
        ]
        for process in processes:
            process.wait_until_ready()
        pids = [process.pid for process in processes] + session.receive_thread_pids()
        wait_until_quiet(pids)
        before_ns, before = cpu_ns(pids), wake_ups(pids)
        time.sleep(window_s)
        used_ns, woken = cpu_ns(pids) - before_ns, wake_ups(pids) - before
        for process in processes:
            process.release()
        for process in processes:
            process.finish()
    return [
        Result(cpu(nodes), middleware.name, "ms/s", (used_ns / 1e6 / window_s,)),
        Result(wakes(nodes), middleware.name, "1/s", (woken / window_s,)),
    ]


def wait_until_quiet(pids: Sequence[int], timeout_s: float = 30.0) -> bool:
    """Wait for a second in which all threads sleep; return whether it came within the timeout."""
    deadline = time.monotonic() + timeout_s
    seen = -1
    while time.monotonic() < deadline:
        now = wake_ups(pids)
        if now == seen and not _wants_cpu(pids):
            return True
        seen = now
        time.sleep(1.0)
    return False


def cpu_ns(pids: Iterable[int]) -> int:
    """Return the total run time of all threads of the processes in ns."""
    return sum(int(path.read_text().split()[0]) for path in _tasks(pids, "schedstat"))


def wake_ups(pids: Iterable[int]) -> int:
    """Return the number of voluntary context switches of all threads of the processes."""
    return sum(int(value) for value in _values(pids, "voluntary_ctxt_switches"))


def _wants_cpu(pids: Iterable[int]) -> bool:
    """Return whether a thread runs, or would if others let it."""
    return any(value.startswith(("R", "D")) for value in _values(pids, "State"))


def _values(pids: Iterable[int], name: str) -> Iterator[str]:
    for path in _tasks(pids, "status"):
        for line in path.read_text().splitlines():
            if line.startswith(f"{name}:"):
                yield line.split()[1]


def _tasks(pids: Iterable[int], name: str) -> Iterable[Path]:
    for pid in pids:
        yield from Path(f"/proc/{pid}/task").glob(f"*/{name}")
