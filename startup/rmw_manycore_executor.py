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
import sys

TYPE_CHECKING = False  # type checkers treat it as typing.TYPE_CHECKING
if TYPE_CHECKING:
    from collections.abc import Callable, Mapping, Sequence
    from importlib.machinery import ModuleSpec
    from types import ModuleType
    from typing import Any

MIN_THREADS = 2  # as in rclcpp: one for the waiting callback, one for the other


def install() -> None:
    """Patch modules of rclpy when this process imports them."""
    if any(isinstance(finder, _Finder) for finder in sys.meta_path):
        return  # site.py of a virtual environment calls this twice
    changes: dict[str, list[Callable[[ModuleType], None]]] = {"rclpy.executors": [change_default]}
    if design := os.environ.get("MANYCORE_RECEIVE"):
        import rmw_manycore_receive

        for name, change in rmw_manycore_receive.changes(design).items():
            changes.setdefault(name, []).append(change)
    sys.meta_path.insert(0, _Finder(changes))


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


class _Finder:
    """Import hook that patches modules of rclpy after they are loaded."""

    def __init__(self, changes: Mapping[str, Sequence[Callable[[ModuleType], None]]]) -> None:
        self._changes = changes

    def find_spec(
        self, name: str, path: Sequence[str] | None = None, target: ModuleType | None = None
    ) -> ModuleSpec | None:
        if name not in self._changes:
            return None
        for finder in sys.meta_path:
            spec = None if isinstance(finder, _Finder) else finder.find_spec(name, path, target)
            if spec is not None and spec.loader is not None:
                _change_when_loaded(spec.loader, self._changes[name])
                return spec
        return None


def _change_when_loaded(loader: Any, changes: Sequence[Callable[[ModuleType], None]]) -> None:
    """Patch the loader of this module so that the changes are made after loading."""
    load = loader.exec_module

    def exec_module(module: ModuleType) -> None:
        load(module)
        for change in changes:
            change(module)

    loader.exec_module = exec_module
