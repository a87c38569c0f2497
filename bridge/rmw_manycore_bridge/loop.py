# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""A thread that moves messages of some routes and keeps their endpoints as the graphs want."""

from __future__ import annotations

import threading
import time
from abc import ABC, abstractmethod
from collections.abc import Callable


class Mover(ABC):
    """A route at work: endpoints on both sides, which only its loop's thread makes and ends."""

    due_s = float("inf")  # on the monotonic clock: when `expire` has something to do

    def __init__(self, fail: Callable[[str], None]) -> None:
        self._fail = fail

    def try_to_reconcile(self) -> None:
        """Let a route that cannot work say so, and the others go on."""
        try:
            self.reconcile()
        except Exception as error:
            self._fail(f"{type(error).__name__}: {error}")

    @abstractmethod
    def reconcile(self) -> None:
        """Make or end endpoints, now that somebody came or went on either side."""

    def expire(self, now_s: float) -> None:  # noqa: B027 (most have nothing that can be overdue)
        """Give up what is overdue."""

    @abstractmethod
    def close(self) -> None:
        """End all endpoints."""


class Loop(ABC):
    """One side's thread: it sleeps until a message comes, a graph changes, or something is due."""

    def __init__(self, name: str) -> None:
        self.name = name
        self.movers: list[Mover] = []
        self.failure: BaseException | None = None
        self._stale = True
        self._stopping = False
        self._failed: Callable[[], None] = _ignore
        self._thread = threading.Thread(target=self._run, name=name)

    def on_failure(self, call: Callable[[], None]) -> None:
        """Have something called when the thread has ended by `failure`."""
        self._failed = call

    def start(self) -> None:
        """Start the thread."""
        self._thread.start()

    def graphs_changed(self) -> None:
        """Have the movers look at the graphs again. Any thread."""
        self._stale = True
        self.wake()

    def stop(self) -> None:
        """End the thread; close_movers() and close() follow once all threads have ended."""
        self._stopping = True
        self.wake()
        self._thread.join()

    def close_movers(self) -> None:
        """End all endpoints of the movers; both their sides are still there."""
        for mover in self.movers:
            mover.close()

    @abstractmethod
    def wake(self) -> None:
        """End the present or the next sleep. Any thread."""

    @abstractmethod
    def turn(self, timeout_s: float | None) -> None:
        """Sleep until there is something to move, and move it."""

    @abstractmethod
    def close(self) -> None:
        """Leave this side."""

    def _run(self) -> None:
        try:
            while not self._stopping:
                if self._stale:
                    self._stale = False
                    for mover in self.movers:
                        mover.try_to_reconcile()
                self.turn(self._expire())
        except BaseException as error:
            self.failure = error
            self._failed()

    def _expire(self) -> float | None:
        """Return how long nothing is due, None = for ever."""
        now_s = time.monotonic()
        for mover in self.movers:
            if mover.due_s <= now_s:
                mover.expire(now_s)
        due_s = min((mover.due_s for mover in self.movers), default=float("inf"))
        return None if due_s == float("inf") else max(due_s - now_s, 0)


def _ignore() -> None:
    """Be told of a failure that nobody asked for."""
