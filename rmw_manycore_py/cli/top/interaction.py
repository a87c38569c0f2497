# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""Interactive `manycore top`: looks, keys and signals."""

from __future__ import annotations

import os
import select
import signal
import time
from collections.abc import Callable

from rich.live import Live

from rmw_manycore_py.cli.top.keys import after_keys
from rmw_manycore_py.cli.top.screen import Choices, screen
from rmw_manycore_py.platform.monitor.watch import Look
from rmw_manycore_py.process.signals import STOP_SIGNALS, SignalInbox, signal_inbox

_FIRST_S = 0.3  # show the first figures early


class Interaction:
    """Redraws the full screen with each look."""

    def __init__(
        self, look_now: Callable[[], Look], period_s: float, count: int | None, choices: Choices
    ) -> None:
        self._look_now = look_now
        self._period_s = period_s
        self._left = count
        self._choices = choices
        self._look = look_now()
        self._due_s = time.monotonic() + min(period_s, _FIRST_S)

    def run(self, keyboard: int) -> bool:
        """Run until a key, a signal or the last look; return whether Ctrl-Z ended it."""
        with (
            signal_inbox((*STOP_SIGNALS, signal.SIGTSTP)) as inbox,
            Live(auto_refresh=False, screen=True) as live,
        ):
            sources: list[int | SignalInbox] = [keyboard, inbox]
            while self._left != 0:
                live.update(screen(self._look, self._choices, live.console.height), refresh=True)
                left_s = max(self._due_s - time.monotonic(), 0)
                ready, _, _ = select.select(sources, [], [], left_s)
                if inbox in ready:
                    return inbox.take() == [signal.SIGTSTP]
                if keyboard in ready and not self._type(os.read(keyboard, 64)):
                    return False
                if time.monotonic() >= self._due_s:
                    self._look_again()
        return False

    def _type(self, keys: bytes) -> bool:
        """Apply keys; return whether to continue."""
        after = after_keys(self._choices, keys.decode(errors="replace")) if keys else None
        self._choices = after or self._choices
        return after is not None

    def _look_again(self) -> None:
        self._look = self._look_now()
        self._due_s = time.monotonic() + self._period_s
        if self._left is not None:
            self._left -= 1
