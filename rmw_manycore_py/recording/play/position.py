# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""Where in a recording a player is: a time that runs at a rate, and stands while it is paused."""

from __future__ import annotations

import threading
import time
from collections.abc import Callable

_NS_PER_S = 1_000_000_000
# A key makes it so much faster or slower, as of `ros2 bag play`.
_RATE_STEP = 1.1
_MIN_RATE, _MAX_RATE = 0.01, 1000.0


class Position:
    """A time of the recording. All threads."""

    def __init__(
        self, rate: float, *, paused: bool, now_ns: Callable[[], int] = time.monotonic_ns
    ) -> None:
        self._now_ns = now_ns
        self._rate, self._is_paused = rate, paused
        self._at_ns, self._since_ns = 0, now_ns()  # the position, and when it was there
        self._steps = 0  # messages to play although it is paused
        self._is_over = False
        self._changed = threading.Condition()

    @property
    def rate(self) -> float:
        """Return how much faster than recorded it runs."""
        return self._rate

    @property
    def is_paused(self) -> bool:
        """Tell whether it stands."""
        return self._is_paused

    @property
    def is_over(self) -> bool:
        """Tell whether it was stopped."""
        return self._is_over

    def at_ns(self) -> int:
        """Return where it is."""
        with self._changed:
            return self._at(self._now_ns())

    def _at(self, now_ns: int) -> int:
        if self._is_paused:
            return self._at_ns
        return self._at_ns + int((now_ns - self._since_ns) * self._rate)

    def jump(self, at_ns: int) -> None:
        """Go to a place."""
        with self._changed:
            self._anchor(at_ns)

    def _anchor(self, at_ns: int) -> None:
        self._at_ns, self._since_ns = at_ns, self._now_ns()
        self._changed.notify_all()

    def toggle_pause(self) -> None:
        """Stand still, or go on."""
        with self._changed:
            self._anchor(self._at(self._now_ns()))
            self._is_paused = not self._is_paused
            self._steps = 0

    def step(self) -> None:
        """Let the next message be played, while it is paused."""
        with self._changed:
            self._steps += self._is_paused
            self._changed.notify_all()

    def faster(self) -> None:
        """Run faster from here on."""
        self._change_rate(_RATE_STEP)

    def slower(self) -> None:
        """Run slower from here on."""
        self._change_rate(1 / _RATE_STEP)

    def _change_rate(self, factor: float) -> None:
        with self._changed:
            self._anchor(self._at(self._now_ns()))
            self._rate = min(max(self._rate * factor, _MIN_RATE), _MAX_RATE)

    def stop(self) -> None:
        """End all waiting, now and later."""
        with self._changed:
            self._is_over = True
            self._changed.notify_all()

    def wait_until(self, at_ns: int) -> int | None:
        """Return, once it is there, by how many ns that is late; None when it was stopped."""
        with self._changed:
            while not self._is_over:
                now_ns = self._now_ns()
                if self._is_paused and self._steps:
                    self._steps -= 1
                    self._anchor(max(at_ns, self._at_ns))
                    return 0
                left_ns = (at_ns - self._at(now_ns)) / self._rate
                if not self._is_paused and left_ns <= 0:
                    return int(-left_ns)
                self._changed.wait(None if self._is_paused else left_ns / _NS_PER_S)
            return None
