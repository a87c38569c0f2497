# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""The skeleton of an application, a process per node: start, rest, tools, messages."""

from __future__ import annotations

import subprocess
import time
from collections.abc import Callable, Sequence
from functools import partial
from pathlib import Path
from tempfile import TemporaryDirectory

from rmw_manycore_program import own_program
from rmw_manycore_py.bench.contenders import FAST_DDS, Middleware
from rmw_manycore_py.bench.idle import cpu_ns, wait_until_quiet, wake_ups
from rmw_manycore_py.bench.memory import KIB, private_bytes
from rmw_manycore_py.bench.question import Question, Run
from rmw_manycore_py.bench.round_trip import in_us
from rmw_manycore_py.bench.scale import graph
from rmw_manycore_py.bench.scale.common import CLUSTERS, OWN, along, at_count, on_curve, spread
from rmw_manycore_py.bench.scale.skeleton import Skeleton
from rmw_manycore_py.bench.scale.skeleton_run import SkeletonRun
from rmw_manycore_py.bench.session import TIMEOUT_S, Session
from rmw_manycore_py.bench.summary import Goal, Result
from rmw_manycore_py.errors import ManycoreError

UP = "starting all nodes, until all topics are matched"
WAKES = "wake-ups of all at rest"
CPU_AT_REST = "CPU time of all at rest"
DESCRIPTORS = "file descriptors of a node"
THREADS = "threads of a node"
PRIVATE = "private memory of a node"
PUBLISHED = "messages published, of those at the profile's rates"
DUE = "messages due, by what was published"
LOST = "messages lost"
AGE = "age of a message when it is taken"
CPU = "CPU time of all while they publish"
TOOLS = {
    "`manycore node list`": ("node", "list"),
    "`manycore top`, first update": ("top", "--count", "1", "--period", "0.1", "--json"),
    "`manycore view`, a picture": ("view", "--once", "--period", "0.1", "-o", "view.svg"),
}

FEWEST = 2  # points: the first nodes alone may have no messages for each other
REST_S = 5.0
TOOL_RUNS = 3

Found = Callable[[str, str, Sequence[float]], Result]


def question(skeleton: Skeleton, duration_s: float) -> Question:
    """Return the question for a skeleton that publishes for this long."""
    size = len(skeleton.nodes)
    counts = dict.fromkeys(max(size // share, 1) for share in (4, 2, 1))

    def measure(run: Run) -> list[Result]:
        results: list[Result] = []
        for middleware in (OWN, FAST_DDS):
            measured = partial(_measure, run, middleware, skeleton, duration_s)
            results += along(run, f"{UP}: {middleware.name}", counts, "nodes", measured, FEWEST)
        return results

    own = at_count(OWN.name, size, "nodes")
    goals = (
        Goal(UP, own, "within", 20),
        Goal(WAKES, own, "within", 0),
        Goal(DESCRIPTORS, own, "within", 40, statistic="largest"),
        Goal(LOST, own, "within", 0),
    )
    rates = (
        f"{skeleton.rate_hz:.0f} messages, {skeleton.deliveries_hz:.0f} deliveries"
        f" and {skeleton.bytes_per_s / 1e6:.1f} MB per second"
    )
    placement = f"nodes on both in turn, over {CLUSTERS} clusters; {rates}"
    return Question("application", measure, goals, placement)


def _measure(
    run: Run, middleware: Middleware, skeleton: Skeleton, duration_s: float, count: int
) -> list[Result]:
    def found(question: str, unit: str, samples: Sequence[float]) -> Result:
        return on_curve(question, middleware.name, count, "nodes", unit, samples)

    part = skeleton.first(count)
    with Session(spread(middleware, count), run.cpus) as session:
        start_s = time.monotonic()
        nodes = SkeletonRun(session, part)
        results = [found(UP, "s", [time.monotonic() - start_s])]
        tools = TOOLS if middleware.is_manycore else {}
        with nodes.named_if_dead():
            results += _rest(nodes, found, REST_S * max(run.share, 0.2))
            results += [
                found(tool, "ms", _tool_ms(run, session, words)) for tool, words in tools.items()
            ]
            return results + _exchange(nodes, found, part, duration_s * max(run.share, 0.1))


def _rest(nodes: SkeletonRun, found: Found, window_s: float) -> list[Result]:
    """Return what the nodes hold, and what they do while nothing happens."""
    pids = nodes.all_pids
    wait_until_quiet(pids)
    before_ns, before = cpu_ns(pids), wake_ups(pids)
    time.sleep(window_s)
    used_ns, woken = cpu_ns(pids) - before_ns, wake_ups(pids) - before
    return [
        found(WAKES, "1/s", [woken / window_s]),
        found(CPU_AT_REST, "ms/s", [used_ns / 1e6 / window_s]),
        found(DESCRIPTORS, "count", [_entries(pid, "fd") for pid in nodes.pids]),
        found(THREADS, "count", [_entries(pid, "task") for pid in nodes.pids]),
        found(PRIVATE, "KiB", [private_bytes(pid) / KIB for pid in nodes.pids]),
    ]


def _entries(pid: int, directory: str) -> int:
    return sum(1 for _ in Path(f"/proc/{pid}/{directory}").iterdir())


def _tool_ms(run: Run, session: Session, words: Sequence[str]) -> list[float]:
    """Return the times from the start of a command to its end."""

    def call() -> None:
        command = own_program("rmw_manycore_py.cli", *words, "--platform", session.platform)
        try:
            done = subprocess.run(
                command, capture_output=True, text=True, timeout=TIMEOUT_S, cwd=directory
            )
        except subprocess.TimeoutExpired as error:
            raise ManycoreError(f"manycore {' '.join(words)} did not end") from error
        if done.returncode:
            raise ManycoreError(f"manycore {' '.join(words)}: {done.stderr}")

    with TemporaryDirectory() as directory:
        return graph.times_ms(call, max(int(TOOL_RUNS * run.share), 1), run.cpus)


def _exchange(
    nodes: SkeletonRun, found: Found, skeleton: Skeleton, duration_s: float
) -> list[Result]:
    """Return how messages at the skeleton's rates fare."""
    pids = nodes.all_pids
    before_ns = cpu_ns(pids)
    nodes.publish(duration_s)
    used_ns = cpu_ns(pids) - before_ns
    nodes.settle()
    exchanged = nodes.finish()
    wanted = skeleton.rate_hz * duration_s
    return [
        *([found(PUBLISHED, "%", [100 * exchanged.published / wanted])] if wanted else []),
        *([found(AGE, "us", in_us(exchanged.ages_ns))] if exchanged.ages_ns else []),
        found(DUE, "count", [exchanged.due]),
        found(LOST, "count", [exchanged.lost]),
        found(CPU, "ms/s", [used_ns / 1e6 / duration_s]),
    ]
