# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""Worker processes of the bench, one per CPU, each driven by a thread."""

from __future__ import annotations

import os
import threading
from collections.abc import Callable, Iterable, Iterator, Sequence
from concurrent.futures import ThreadPoolExecutor
from queue import SimpleQueue
from typing import Protocol, TypeVar

from rmw_manycore_py.process.helper_process import HelperProcess

T = TypeVar("T")
R = TypeVar("R")


class Helpers(Protocol):
    """Executes the work, in several processes or in this one."""

    def map(self, function: Callable[[T], R], items: Iterable[T]) -> Iterator[R]:
        """Return the results of a function for all items, in order."""
        ...

    def call(self, function: Callable[..., R], *arguments: object) -> R:
        """Return the result of a module-level function."""
        ...


class Here:
    """Executes everything in the calling thread."""

    def map(self, function: Callable[[T], R], items: Iterable[T]) -> Iterator[R]:
        """Return the results of a function for all items, in order."""
        return map(function, items)

    def call(self, function: Callable[..., R], *arguments: object) -> R:
        """Return the result of a module-level function."""
        return function(*arguments)


class TrustHelpers:
    """One process per CPU, until the context exits.

    :param cpus: each gets a thread and a process.
    """

    def __init__(self, cpus: Sequence[int]) -> None:
        self._own = threading.local()
        self._helpers: list[HelperProcess] = []
        self._free_cpus: SimpleQueue[int] = SimpleQueue()
        for cpu in cpus:
            self._free_cpus.put(cpu)
        self._executor = ThreadPoolExecutor(len(cpus), "trust", self._begin_thread)

    def __enter__(self) -> TrustHelpers:
        return self

    def __exit__(self, *_: object) -> None:
        for helper in list(self._helpers):
            helper.close()
        self._executor.shutdown(cancel_futures=True)

    def map(self, function: Callable[[T], R], items: Iterable[T]) -> Iterator[R]:
        """Return the results of a function for all items, in order; runs on the threads."""
        return self._executor.map(function, items)

    def call(self, function: Callable[..., R], *arguments: object) -> R:
        """Return the result of a module-level function, run in the thread's process."""
        helper: HelperProcess = self._own.helper
        return helper.call(function, *arguments)

    def _begin_thread(self) -> None:
        """Pin the thread; its process inherits the CPU."""
        os.sched_setaffinity(0, {self._free_cpus.get()})
        self._own.helper = HelperProcess("bench", niceness=0)
        self._helpers.append(self._own.helper)
