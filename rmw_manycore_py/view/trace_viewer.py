# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""A page's place in a trace."""

from __future__ import annotations

from typing import Any

from rmw_manycore_py.view.shown import Shown
from rmw_manycore_py.view.trace_run import LAST_STEP, TraceRun


class TraceViewer(Shown):
    """Shows the whole run first, then the moments that the page asks for."""

    is_live = False

    def __init__(self, run: TraceRun) -> None:
        super().__init__(run.title)
        self._run = run
        self._step: int | None = None
        self.is_there = True
        self.history = run.history
        self.note(run.events)
        self.seek(None)

    def seek(self, step: int | None) -> None:
        """Show the moment of a step, from 0 to `LAST_STEP`; None: the whole."""
        self._step = None if step is None else min(max(step, 0), LAST_STEP)
        look = self._run.whole if self._step is None else self._run.look_at(self._step)
        self.show(look, self._run.chip)

    @property
    def position(self) -> dict[str, Any]:
        """Step and length of the trace."""
        return {"step": self._step, "steps": LAST_STEP, "seconds": self._run.duration_s}
