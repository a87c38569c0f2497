# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""Progress of a recording or playback: one line on a terminal, else occasional lines."""

from __future__ import annotations

import sys
import time

LINE_PERIOD_S = 10.0
TERMINAL_PERIOD_S = 0.2
_CLEAR = "\r\x1b[K"


class StatusLine:
    """Writes to standard error, below permanent lines. Thread-safe.

    Silent once writing has failed: a recording goes on after its terminal or reader has gone.
    """

    def __init__(self, *, quiet: bool = False) -> None:
        self._quiet = quiet
        self._is_terminal = sys.stderr.isatty()
        self._said_s = time.monotonic()

    @property
    def period_s(self) -> float | None:
        """Return the update period; None = never."""
        if self._quiet:
            return None
        return TERMINAL_PERIOD_S if self._is_terminal else LINE_PERIOD_S

    def show(self, text: str) -> None:
        """Show progress, unless it was shown shortly before."""
        now_s = time.monotonic()
        if self.period_s is None or now_s - self._said_s < self.period_s:
            return
        self._said_s = now_s
        self._write(f"{_CLEAR}{text}" if self._is_terminal else f"{text}\n")

    def print_line(self, text: str) -> None:
        """Print a permanent line."""
        if not self._quiet:
            self._write(f"{_CLEAR}{text}\n" if self._is_terminal else f"{text}\n")

    def clear(self) -> None:
        """Clear the line."""
        if self._is_terminal and not self._quiet:
            self._write(_CLEAR)

    def _write(self, text: str) -> None:
        try:
            sys.stderr.write(text)
            sys.stderr.flush()
        except OSError:  # a terminal that hung up, a closed pipe, a full disk
            self._quiet = True
