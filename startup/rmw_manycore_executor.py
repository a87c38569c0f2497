# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""Gives rclpy's MultiThreadedExecutor at least two threads in nodes pinned to a core.

By default rclpy uses as many threads as the process has CPUs. A node on a core has one CPU; with
one thread, a callback that waits for another callback, e.g. one that calls a service, deadlocks.
`rmw_manycore.pth` calls `install()` in every Python process that is assigned a core; rclpy itself
is imported only by programs that import it. See docs/design/run.md.

Imports only what Python has already imported: this runs before everything else.
"""

from __future__ import annotations

import os

from rmw_manycore_loading import ChangesAfterLoading

TYPE_CHECKING = False  # type checkers treat it as typing.TYPE_CHECKING
if TYPE_CHECKING:
    from collections.abc import Callable
    from types import ModuleType
    from typing import Any

MIN_THREADS = 2  # as in rclcpp: one for the waiting callback, one for the other


def install() -> None:
    """Patch modules of rclpy when this process imports them."""
    changes: dict[str, list[Callable[[ModuleType], None]]] = {"rclpy.executors": [change_default]}
    if design := os.environ.get("MANYCORE_RECEIVE"):
        import rmw_manycore_receive

        for name, change in rmw_manycore_receive.changes(design).items():
            changes.setdefault(name, []).append(change)
    ChangesAfterLoading.install("executor", lambda name: changes.get(name, ()))


def default_threads() -> int:
    """Return the default number of executor threads: one per CPU, at least two."""
    return max(MIN_THREADS, len(os.sched_getaffinity(0)))


def change_default(executors: ModuleType) -> None:
    """Set the default of MultiThreadedExecutor to `default_threads`; explicit numbers are kept."""
    from functools import wraps

    executor = getattr(executors, "MultiThreadedExecutor", None)
    if executor is None:  # moved in a later rclpy
        return
    original: Callable[..., None] = executor.__init__

    @wraps(original)
    def initialise(self: object, num_threads: int | None = None, *more: Any, **named: Any) -> None:
        if num_threads is None:
            num_threads = default_threads()
        original(self, num_threads, *more, **named)

    executor.__init__ = initialise
