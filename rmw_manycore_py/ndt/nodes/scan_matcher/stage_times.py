# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""Durations of the consecutive stages of a scan."""

from __future__ import annotations

from rmw_manycore_py.ndt.nodes.scan_matcher.diagnostics import Diagnostics
from rmw_manycore_py.process.steady import steady_s


class StageTimes:
    """Starts with the scan; the times include other programs on the CPU."""

    def __init__(self) -> None:
        self._start_s = self._last_s = steady_s()
        self._stages_ms: dict[str, float] = {}

    def end(self, stage: str) -> None:
        """Record the end of a stage and the start of the next."""
        now_s = steady_s()
        self._stages_ms[stage] = 1e3 * (now_s - self._last_s)
        self._last_s = now_s

    @property
    def total_ms(self) -> float:
        """Return the time since the start."""
        return 1e3 * (steady_s() - self._start_s)

    def report(self, diagnostics: Diagnostics) -> None:
        """Add a value per stage."""
        for stage, time_ms in self._stages_ms.items():
            diagnostics.value(f"{stage}_time_ms", round(time_ms, 3))
