# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""The running platform that all pages show."""

from __future__ import annotations

import asyncio
import time

from rmw_manycore_py.errors import ManycoreError
from rmw_manycore_py.native import _transport
from rmw_manycore_py.picture.chip import Chip
from rmw_manycore_py.platform.monitor.events import Event
from rmw_manycore_py.platform.monitor.watch import Look, Watch
from rmw_manycore_py.view.shown import Shown


class Viewer(Shown):
    """Looks at a platform periodically, and notifies pages of each look."""

    def __init__(self, platform: str, period_s: float) -> None:
        super().__init__(f"waiting for platform {platform} to start")
        self.platform = platform
        self._period_s = period_s
        self._watch = Watch(platform)

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
            self._go_on(look, chip)

    def _go_on(self, look: Look, chip: Chip) -> None:
        if not self.is_there:
            self.note((Event("platform", f"platform {self.platform} has started"),))
        self.is_there, self.state = True, f"platform {self.platform}"
        if look.virtual_s is not None:
            self.state += f", virtual time {look.virtual_s:.3f} s"
        self.show(look, chip)
        self.history.append(look, time.time())
        self.note(look.happened)

    def _note_end(self) -> None:
        if self.is_there:
            self.state = f"platform {self.platform} has ended; waiting for it to start again"
            self.note(self._watch.last_words)
        self.is_there = False
