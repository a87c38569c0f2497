# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""Reading the graph of many nodes, once or continuously beside other measurements."""

from __future__ import annotations

import os
import subprocess
import threading
import time
from collections.abc import Callable, Iterator, Sequence
from contextlib import contextmanager

from rmw_manycore_program import own_program
from rmw_manycore_py.bench.session import TIMEOUT_S, Session, pinned_to
from rmw_manycore_py.errors import ManycoreError
from rmw_manycore_py.native._transport import Platform


def read(platform: Platform) -> None:
    """Read all nodes and endpoints, as tools with a picture of the graph do."""
    platform.nodes()
    platform.endpoints()


def list_nodes(session: Session, nodes: int) -> None:
    """Run `manycore node list`, which must show at least as many nodes."""
    command = own_program(*("rmw_manycore_py.cli", "node", "list", "--platform", session.platform))
    listed = subprocess.run(command, capture_output=True, text=True, timeout=TIMEOUT_S)
    shown = len(listed.stdout.splitlines())
    if listed.returncode != 0 or shown < nodes:
        raise ManycoreError(
            f"manycore node list shows {shown} of {nodes} nodes, "
            f"exit status {listed.returncode}: {listed.stderr}"
        )


@contextmanager
def over_and_over(action: Callable[[], None], cpu: int) -> Iterator[None]:
    """Repeat an action during the block, in a thread on this CPU; processes it starts stay there.

    The block starts after the first time.
    """
    is_over, has_begun = threading.Event(), threading.Event()
    errors: list[ManycoreError] = []

    def repeat() -> None:
        os.sched_setaffinity(0, [cpu])  # this thread only
        try:
            while not is_over.is_set():
                action()
                has_begun.set()
        except ManycoreError as error:
            errors.append(error)
            has_begun.set()

    repeater = threading.Thread(target=repeat)
    repeater.start()
    try:
        has_begun.wait()
        yield
    finally:
        is_over.set()
        repeater.join()
    if errors:
        raise errors[0]


def times_ms(action: Callable[[], None], count: int, cpus: Sequence[int]) -> list[float]:
    """Return how long an action takes each time, on these CPUs."""
    with pinned_to(cpus):
        return [ms_of(action) for _ in range(count)]


def ms_of(action: Callable[[], None]) -> float:
    """Return how long an action takes."""
    start_ns = time.monotonic_ns()
    action()
    return (time.monotonic_ns() - start_ns) / 1e6
