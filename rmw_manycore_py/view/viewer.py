# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""State shared by all pages: latest look, its picture, and earlier events."""

from __future__ import annotations

import asyncio
import time
from collections import deque
from typing import Any

from rmw_manycore_py.errors import ManycoreError
from rmw_manycore_py.native import _transport
from rmw_manycore_py.picture.chip import Chip
from rmw_manycore_py.picture.marks import Marks
from rmw_manycore_py.platform.monitor.events import Event
from rmw_manycore_py.platform.monitor.watch import Look, Watch
from rmw_manycore_py.view.history import History

_KEPT_EVENTS = 500


class Viewer:
    """Looks at a platform periodically, and notifies pages of each look."""

    def __init__(self, platform: str, period_s: float) -> None:
        self.platform = platform
        self._period_s = period_s
        self._watch = Watch(platform)
        self._next = asyncio.Event()
        self.look: Look | None = None  # latest look, also of an ended platform
        self.chip: Chip | None = None
        self.marks: Marks = {}
        self.state = f"waiting for platform {platform} to start"
        self.is_there = False
        self.history = History()
        self.events: deque[tuple[int, Event]] = deque(maxlen=_KEPT_EVENTS)
        self._happened = 0

    async def run(self) -> None:
        """Look until cancelled; the platform may start and end meanwhile."""
        try:
            due_s = time.monotonic()
            while True:
                await self._step()
                self._next.set()
                self._next = asyncio.Event()
                due_s = max(due_s + self._period_s, time.monotonic())
                await asyncio.sleep(due_s - time.monotonic())
        finally:
            self._watch.close()

    async def next_look(self) -> None:
        """Wait for the next look."""
        await self._next.wait()

    async def _step(self) -> None:
        try:
            look = await asyncio.to_thread(self._watch.look)
        except (_transport.PlatformError, ManycoreError) as error:
            self.is_there = False
            self.state = f"platform {self.platform} cannot be read: {error}"
            return
        if look is None:
            self._note_end()
        else:
            chip = self.chip
            if chip is None or self.look is None or not chip.fits(look, self.look):
                chip = await asyncio.to_thread(Chip.of, look)
            self._show(look, chip)

    def _show(self, look: Look, chip: Chip) -> None:
        if not self.is_there:
            self._note((Event("platform", f"platform {self.platform} has started"),))
        self.is_there, self.state = True, f"platform {self.platform}"
        if look.virtual_s is not None:
            self.state += f", virtual time {look.virtual_s:.3f} s"
        self.look, self.chip = look, chip
        self.marks = chip.marks(look)
        self.history.append(look, time.time())
        self._note(look.happened)

    def _note_end(self) -> None:
        if self.is_there:
            self.state = f"platform {self.platform} has ended; waiting for it to start again"
            self._note(self._watch.last_words)
        self.is_there = False

    def _note(self, happened: tuple[Event, ...]) -> None:
        for event in happened:
            self._happened += 1
            self.events.append((self._happened, event))

    def happened_since(self, number: int) -> tuple[int, list[dict[str, Any]]]:
        """Return the number of the last event, and all events after `number`."""
        rows = [event.row() for own, event in self.events if own > number]
        return self._happened, rows
