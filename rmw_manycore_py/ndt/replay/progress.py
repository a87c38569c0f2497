# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""Progress of a replay: a bar on a terminal, else occasional lines."""

from __future__ import annotations

from rich.console import Console
from rich.progress import BarColumn, MofNCompleteColumn, Progress, TextColumn

from rmw_manycore_py.ndt.replay.tally import Played, Tally
from rmw_manycore_py.process.progress import ProgressLines


class ReplayProgress:
    """Shows scans played, and error and latency of the last answer, on standard error."""

    def __init__(self, tally: Tally, scans: int) -> None:
        self._tally = tally
        console = Console(stderr=True)
        self._lines = None if console.is_terminal else ProgressLines("scan", scans, console)
        self._played = 0
        self._progress = Progress(
            TextColumn("scan"),
            MofNCompleteColumn(),
            BarColumn(),
            TextColumn("{task.description}"),
            console=console,
            disable=not console.is_terminal,
        )
        self._task = self._progress.add_task("", total=scans)

    def __enter__(self) -> ReplayProgress:
        self._progress.start()
        return self

    def __exit__(self, *_: object) -> None:
        self._progress.stop()

    def played(self, row: Played) -> None:
        """Count a scan as played."""
        self._played += 1
        text = self._text(row)
        self._progress.update(self._task, advance=1, description=text)
        if self._lines is not None:
            self._lines.done(self._played, text)

    def _text(self, row: Played) -> str:
        answered = [one for one in self._tally.rows[-5:] if one.error is not None]
        missed = f"{self._tally.late()} late, {self._tally.lost() - (row.result is None)} lost"
        if not answered or (error := answered[-1].error) is None:
            return missed
        latency_ms = answered[-1].latency_ms or 0.0
        return f"error {error[0]:.3f} m {error[1]:.2f} deg, {latency_ms:.1f} ms, {missed}"
