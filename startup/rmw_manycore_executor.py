# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""Gives rclpy's MultiThreadedExecutor at least two threads in a node that has a core.

By default rclpy takes as many threads as the process has CPUs. A node on a core has one CPU, and
with one thread a callback that waits for another callback, as one that calls a service does, waits
for ever. `rmw_manycore.pth` calls `install()` in every python process that a core is given to;
rclpy itself is imported only by programs that import it. See docs/design/run.md.

Imports nothing that python has not imported by then: this runs before everything else.
"""

from __future__ import annotations

import os
import sys

TYPE_CHECKING = False  # as typing has it, without importing typing
if TYPE_CHECKING:
    from collections.abc import Callable, Sequence
    from importlib.machinery import ModuleSpec
    from types import ModuleType
    from typing import Any

MODULE = "rclpy.executors"
MIN_THREADS = 2  # as rclcpp has it: one for the callback that waits, one for what it waits for


def install() -> None:
    """Have the default changed when, and if, this process imports rclpy's executors."""
    if not any(isinstance(finder, _Finder) for finder in sys.meta_path):
        sys.meta_path.insert(0, _Finder())  # site.py of a virtual environment comes here twice


def default_threads() -> int:
    """Return how many threads an executor has that is not told: one per CPU, and at least two."""
    return max(MIN_THREADS, len(os.sched_getaffinity(0)))


def change_default(executors: ModuleType) -> None:
    """Give MultiThreadedExecutor the default of `default_threads`; a given number stays."""
    from functools import wraps

    executor = getattr(executors, "MultiThreadedExecutor", None)
    if executor is None:  # a later rclpy may have moved it
        return
    original: Callable[..., None] = executor.__init__

    @wraps(original)
    def initialise(self: object, num_threads: int | None = None, *more: Any, **named: Any) -> None:
        if num_threads is None:
            num_threads = default_threads()
        original(self, num_threads, *more, **named)

    executor.__init__ = initialise


class _Finder:
    """Finds rclpy's executors where the others do, and has them changed once they are loaded."""

    @staticmethod
    def find_spec(
        name: str, path: Sequence[str] | None = None, target: ModuleType | None = None
    ) -> ModuleSpec | None:
        if name != MODULE:
            return None
        for finder in sys.meta_path:
            spec = None if isinstance(finder, _Finder) else finder.find_spec(name, path, target)
            if spec is not None and spec.loader is not None:
                _change_when_loaded(spec.loader)
                return spec
        return None


def _change_when_loaded(loader: Any) -> None:
    """Let the loader of this one module change it afterwards; it stays the loader that it is."""
    load = loader.exec_module

    def exec_module(module: ModuleType) -> None:
        load(module)
        change_default(module)

    loader.exec_module = exec_module
