# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""Pending requests of a service."""

from __future__ import annotations

import threading
import time
from collections.abc import Callable
from dataclasses import dataclass
from typing import Any


@dataclass(frozen=True)
class Asked:
    """Pending request: its caller, arrival time and deadline."""

    caller: Any
    since_ns: int
    due_s: float


class Pending:
    """Pending requests of one service by forwarded sequence number. Thread-safe."""

    def __init__(self, timeout_s: float | None) -> None:
        self._timeout_s = timeout_s
        self._asked: dict[int, Asked] = {}
        self._lock = threading.Lock()

    def ask(self, caller: Any, send: Callable[[], int]) -> None:
        """Send a request and register it; lookups of replies wait for the registration."""
        with self._lock:
            self._asked[send()] = self._now(caller)

    def _now(self, caller: Any) -> Asked:
        due_s = float("inf") if self._timeout_s is None else time.monotonic() + self._timeout_s
        return Asked(caller, time.time_ns(), due_s)

    def answered(self, number: int) -> Asked | None:
        """Remove and return the pending request; None if it is no longer pending."""
        with self._lock:
            return self._asked.pop(number, None)

    def overdue(self, now_s: float) -> list[Asked]:
        """Remove and return the requests whose deadline has passed."""
        with self._lock:
            late = [number for number, asked in self._asked.items() if asked.due_s <= now_s]
            return [self._asked.pop(number) for number in late]

    def all(self) -> list[Asked]:
        """Remove and return all pending requests."""
        return self.overdue(float("inf"))

    @property
    def due_s(self) -> float:
        """Earliest deadline, CLOCK_MONOTONIC."""
        with self._lock:
            return min((asked.due_s for asked in self._asked.values()), default=float("inf"))
