# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""Position of a player: a clock with a rate that can be paused."""

from __future__ import annotations

import threading
import time
from collections.abc import Callable

_NS_PER_S = 1_000_000_000
# Change of the rate per key press, as in `ros2 bag play`.
_RATE_STEP = 1.1
_MIN_RATE, _MAX_RATE = 0.01, 1000.0


class Position:
    """Time in the recording. Thread-safe."""

    def __init__(
        self,
        rate: float,
        paused: bool = False,
        *,
        now_ns: Callable[[], int] = time.monotonic_ns,
        sleep: Callable[[float], None] | None = None,
    ) -> None:
        """Start at 0.

        :param now_ns: clock.
        :param sleep: waits for that clock, in seconds; None: the clock is the kernel's, and a pause
            or a stop ends waits.
        """
        self._now_ns, self._sleep = now_ns, sleep
        self._rate, self._is_paused = rate, paused
        self._at_ns, self._since_ns = 0, now_ns()  # position, and when it was set
        self._steps = 0  # messages to play while paused
        self._is_over = False
        self._changed = threading.Condition()

    @property
    def rate(self) -> float:
        """Return the playback rate."""
        return self._rate

    @property
    def is_paused(self) -> bool:
        """Return whether it is paused."""
        return self._is_paused

    @property
    def is_over(self) -> bool:
        """Return whether it was stopped."""
        return self._is_over

    def at_ns(self) -> int:
        """Return the current position in ns."""
        with self._changed:
            return self._at(self._now_ns())

    def _at(self, now_ns: int) -> int:
        if self._is_paused:
            return self._at_ns
        return self._at_ns + int((now_ns - self._since_ns) * self._rate)

    def jump(self, at_ns: int) -> None:
        """Set the position."""
        with self._changed:
            self._anchor(at_ns)

    def _anchor(self, at_ns: int) -> None:
        self._at_ns, self._since_ns = at_ns, self._now_ns()
        self._changed.notify_all()

    def toggle_pause(self) -> None:
        """Pause or resume."""
        with self._changed:
            self._anchor(self._at(self._now_ns()))
            self._is_paused = not self._is_paused
            self._steps = 0

    def step(self) -> None:
        """Play the next message while paused."""
        with self._changed:
            self._steps += self._is_paused
            self._changed.notify_all()

    def faster(self) -> None:
        """Increase the rate."""
        self._change_rate(_RATE_STEP)

    def slower(self) -> None:
        """Decrease the rate."""
        self._change_rate(1 / _RATE_STEP)

    def _change_rate(self, factor: float) -> None:
        with self._changed:
            self._anchor(self._at(self._now_ns()))
            self._rate = min(max(self._rate * factor, _MIN_RATE), _MAX_RATE)

    def stop(self) -> None:
        """Stop; all current and future waits return."""
        with self._changed:
            self._is_over = True
            self._changed.notify_all()

    def wait_until(self, at_ns: int) -> int | None:
        """Wait for a position; return the lateness in ns, or None if stopped."""
        while True:
            with self._changed:
                if self._is_over:
                    return None
                now_ns = self._now_ns()
                if self._is_paused and self._steps:
                    self._steps -= 1
                    self._anchor(max(at_ns, self._at_ns))
                    return 0
                left_ns = (at_ns - self._at(now_ns)) / self._rate
                if not self._is_paused and left_ns <= 0:
                    return int(-left_ns)
                left_s = min(left_ns / _NS_PER_S, threading.TIMEOUT_MAX)
                if self._sleep is None:
                    self._changed.wait(None if self._is_paused else left_s)
                    continue
            self._sleep(left_s)
