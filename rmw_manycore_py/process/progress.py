# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""Progress of long work on standard error: a bar on a terminal, else occasional lines."""

from __future__ import annotations

import time
from collections.abc import Iterable, Iterator
from typing import TypeVar

from rich.console import Console
from rich.progress import track

LINE_PERIOD_S = 2.0

T = TypeVar("T")


class ProgressLines:
    """Lines for logs and pipes; silent for work shorter than LINE_PERIOD_S."""

    def __init__(self, what: str, total: int, console: Console) -> None:
        self._what = what
        self._total = total
        self._console = console
        self._said_s = time.monotonic()

    def done(self, count: int, remark: str = "") -> None:
        """Report progress, unless it was reported shortly before."""
        if time.monotonic() - self._said_s < LINE_PERIOD_S:
            return
        self._said_s = time.monotonic()
        text = f"{self._what} {count} of {self._total}"
        self._console.print(
            f"{text}: {remark}" if remark else text, highlight=False, soft_wrap=True
        )


def tracked(items: Iterable[T], what: str, total: int) -> Iterator[T]:
    """Yield items and show how many of `total` have been taken."""
    console = Console(stderr=True)
    if console.is_terminal:
        yield from track(items, what, total, console=console, transient=True)
        return
    lines = ProgressLines(what, total, console)
    for count, item in enumerate(items, start=1):
        yield item
        lines.done(count)
