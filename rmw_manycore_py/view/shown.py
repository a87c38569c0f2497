# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""What a page shows: a look, its picture, and what happened before."""

from __future__ import annotations

import asyncio
from collections import deque
from collections.abc import Iterable
from typing import Any

from rmw_manycore_py.picture.chip import Chip
from rmw_manycore_py.picture.marks import Marks
from rmw_manycore_py.platform.monitor.events import Event
from rmw_manycore_py.platform.monitor.watch import Look
from rmw_manycore_py.view.history import History

_KEPT_EVENTS = 500


class Shown:
    """State of a running platform, or of a moment in a trace."""

    is_live = True  # whether it goes on by itself

    def __init__(self, state: str) -> None:
        self.look: Look | None = None  # latest look, also of an ended platform
        self.chip: Chip | None = None
        self.marks: Marks = {}
        self.state = state
        self.is_there = False
        self.history = History()
        self.events: deque[tuple[int, Event]] = deque(maxlen=_KEPT_EVENTS)
        self._happened = 0
        self._next = asyncio.Event()

    async def next_look(self) -> None:
        """Wait for the next look."""
        await self._next.wait()

    def show(self, look: Look, chip: Chip) -> None:
        """Show a look."""
        self.look, self.chip = look, chip
        self.marks = chip.marks(look)

    def seek(self, step: int | None) -> None:
        """Show another moment, if it is a trace; None: the whole."""

    @property
    def position(self) -> dict[str, Any] | None:
        """Moment of a trace that is shown; None for a running platform."""
        return None

    def note(self, happened: Iterable[Event]) -> None:
        """Remember events."""
        for event in happened:
            self._happened += 1
            self.events.append((self._happened, event))

    def happened_since(self, number: int) -> tuple[int, list[dict[str, Any]]]:
        """Return the number of the last event, and all events after `number`."""
        rows = [event.row() for own, event in self.events if own > number]
        return self._happened, rows
