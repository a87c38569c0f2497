# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""Processes that align and search for the bench, one on each CPU, each fed by a thread."""

from __future__ import annotations

import os
import threading
from collections.abc import Callable, Iterable, Iterator, Sequence
from concurrent.futures import ThreadPoolExecutor
from queue import SimpleQueue
from types import TracebackType
from typing import Protocol, TypeVar

from rmw_manycore_py.helper_process import HelperProcess

T = TypeVar("T")
R = TypeVar("R")


class Helpers(Protocol):
    """What does the work: several processes, or this one."""

    def map(self, function: Callable[[T], R], items: Iterable[T]) -> Iterator[R]:
        """Return what a function says of each item, in their order."""
        ...

    def call(self, function: Callable[..., R], *arguments: object) -> R:
        """Return what a function of a module returns."""
        ...


class Here:
    """Does all of it in the calling thread."""

    def map(self, function: Callable[[T], R], items: Iterable[T]) -> Iterator[R]:
        """Return what a function says of each item, in their order."""
        return map(function, items)

    def call(self, function: Callable[..., R], *arguments: object) -> R:
        """Return what a function of a module returns."""
        return function(*arguments)


class TrustHelpers:
    """A process on each CPU, until it is left.

    :param cpus: a thread and a process for each.
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

    def __exit__(
        self,
        kind: type[BaseException] | None,
        error: BaseException | None,
        trace: TracebackType | None,
    ) -> None:
        for helper in list(self._helpers):
            helper.close()
        self._executor.shutdown(cancel_futures=True)

    def map(self, function: Callable[[T], R], items: Iterable[T]) -> Iterator[R]:
        """Return what a function says of each item, in their order; on the threads."""
        return self._executor.map(function, items)

    def call(self, function: Callable[..., R], *arguments: object) -> R:
        """Return what a function of a module returns in the thread's process."""
        helper: HelperProcess = self._own.helper
        return helper.call(function, *arguments)

    def _begin_thread(self) -> None:
        """Pin the thread, from which its process inherits the CPU."""
        os.sched_setaffinity(0, {self._free_cpus.get()})
        self._own.helper = HelperProcess("bench", niceness=0)
        self._helpers.append(self._own.helper)
