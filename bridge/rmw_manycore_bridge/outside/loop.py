# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""Event-loop thread that forwards messages and adapts endpoints to the graph."""

from __future__ import annotations

import threading
import time
from abc import ABC, abstractmethod
from collections.abc import Callable


class Mover(ABC):
    """Active route: its endpoints are created and destroyed only by its loop's thread."""

    due_s = float("inf")  # CLOCK_MONOTONIC, when to call `expire`

    def __init__(self, fail: Callable[[str], None]) -> None:
        self._fail = fail

    def try_to_reconcile(self) -> None:
        """Reconcile; on an error, mark the route as failed and keep the others running."""
        try:
            self.reconcile()
        except Exception as error:
            self._fail(f"{type(error).__name__}: {error}")

    @abstractmethod
    def reconcile(self) -> None:
        """Create or destroy endpoints after a graph change on either side."""

    def expire(self, now_s: float) -> None:  # noqa: B027 (most movers have no deadlines)
        """Handle expired deadlines."""

    @abstractmethod
    def close(self) -> None:
        """Destroy all endpoints."""


class Loop(ABC):
    """Thread of one side: blocks until a message, a graph change, or a deadline."""

    def __init__(self, name: str) -> None:
        self.name = name
        self.movers: list[Mover] = []
        self.failure: BaseException | None = None
        self._stale = True
        self._stopping = False
        self._failed: Callable[[], None] = _ignore
        # Held while movers run: an engine may run one in a thread of its own.
        self._moving = threading.Lock()
        self._thread = threading.Thread(target=self._run, name=name)

    def on_failure(self, call: Callable[[], None]) -> None:
        """Set the callback for when the thread has ended with `failure`."""
        self._failed = call

    def start(self) -> None:
        """Start the thread."""
        self._thread.start()

    def graphs_changed(self) -> None:
        """Make the movers reconcile with the graphs. Thread-safe."""
        self._stale = True
        self.wake()

    def stop(self) -> None:
        """Stop the thread; call close_movers() and close() once all threads have ended."""
        self._stopping = True
        self.wake()
        self._thread.join()

    def close_movers(self) -> None:
        """Destroy all endpoints of the movers, while both sides still exist."""
        with self._moving:
            for mover in self.movers:
                mover.close()

    @abstractmethod
    def wake(self) -> None:
        """Interrupt the current or next wait. Thread-safe."""

    @abstractmethod
    def turn(self, timeout_s: float | None) -> None:
        """Block until something is ready, and forward it."""

    @abstractmethod
    def close(self) -> None:
        """Leave this side."""

    def _run(self) -> None:
        try:
            while not self._stopping:
                with self._moving:
                    self._reconcile()
                    timeout_s = self._expire()
                self.turn(timeout_s)
        except BaseException as error:
            self.failure = error
            self._failed()

    def _reconcile(self) -> None:
        if self._stale:
            self._stale = False
            for mover in self.movers:
                mover.try_to_reconcile()

    def _expire(self) -> float | None:
        """Return the seconds until the next deadline; None if there is none."""
        now_s, due_s = time.monotonic(), self._due_s()
        if due_s <= now_s:
            for mover in self.movers:
                if mover.due_s <= now_s:
                    mover.expire(now_s)
            due_s = self._due_s()
        return None if due_s == float("inf") else max(due_s - now_s, 0)

    def _due_s(self) -> float:
        return min((mover.due_s for mover in self.movers), default=float("inf"))


def _ignore() -> None:
    """Default failure callback."""
