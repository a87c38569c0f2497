# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""Scans that wait for their guess, or for the previous scan to be matched."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import Any

MAX_WAITING = 5


@dataclass(frozen=True)
class WaitingScan:
    """A waiting scan; from `expires_s` on (CLOCK_MONOTONIC) it does not wait for its guess."""

    message: Any
    stamp_s: float
    expires_s: float


class ScanInbox:
    """Selects the newest scan that can be matched; older scans are skipped.

    Not thread-safe.

    :param has_guess: returns whether the guess for a stamp is available.
    :param timeout_s: how long a scan waits for its guess.
    """

    def __init__(self, has_guess: Callable[[float], bool], timeout_s: float) -> None:
        self._has_guess = has_guess
        self._timeout_s = timeout_s
        self._waiting: list[WaitingScan] = []
        self._skipped: list[WaitingScan] = []

    def put(self, message: Any, stamp_s: float, now_s: float) -> None:
        """Add a scan; beyond MAX_WAITING the oldest is skipped."""
        self._waiting.append(WaitingScan(message, stamp_s, now_s + self._timeout_s))
        if len(self._waiting) > MAX_WAITING:
            self._skipped.append(self._waiting.pop(0))

    def take(self, now_s: float) -> WaitingScan | None:
        """Return the newest scan with a guess, else the newest that has waited long enough."""
        with_guess = [self._has_guess(scan.stamp_s) for scan in self._waiting]
        expired = [scan.expires_s <= now_s for scan in self._waiting]
        ready = with_guess if any(with_guess) else expired
        if not any(ready):
            return None
        index = max(i for i, is_ready in enumerate(ready) if is_ready)
        taken = self._waiting[index]
        self._skipped += self._waiting[:index]
        del self._waiting[: index + 1]
        return taken

    def take_skipped(self) -> list[WaitingScan]:
        """Return the scans skipped since the last call."""
        skipped, self._skipped = self._skipped, []
        return skipped

    def due_s(self) -> float | None:
        """Return when the next scan stops waiting for its guess; None without scans."""
        return min((scan.expires_s for scan in self._waiting), default=None)
