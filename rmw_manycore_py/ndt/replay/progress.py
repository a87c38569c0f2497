# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""The line that tells how a replay is going."""

from __future__ import annotations

from rich.console import Console
from rich.progress import BarColumn, MofNCompleteColumn, Progress, TextColumn

from rmw_manycore_py.ndt.replay.tally import Played, Tally


class ReplayProgress:
    """Scans played, and error and latency of the last that was answered; on standard error."""

    def __init__(self, tally: Tally, scans: int) -> None:
        self._tally = tally
        self._progress = Progress(
            TextColumn("scan"),
            MofNCompleteColumn(),
            BarColumn(),
            TextColumn("{task.description}"),
            console=Console(stderr=True),
        )
        self._task = self._progress.add_task("", total=scans)

    def __enter__(self) -> ReplayProgress:
        self._progress.start()
        return self

    def __exit__(self, *_: object) -> None:
        self._progress.stop()

    def played(self, row: Played) -> None:
        """Show the scan as played."""
        answered = [one for one in self._tally.rows[-5:] if one.error is not None]
        text = ""
        if answered and (error := answered[-1].error) is not None:
            latency_ms = answered[-1].latency_ms or 0.0
            text = f"error {error[0]:.3f} m {error[1]:.2f} deg, {latency_ms:.1f} ms"
        waiting = row.result is None
        missed = f"{self._tally.late()} late, {self._tally.lost() - waiting} lost"
        self._progress.update(self._task, advance=1, description=f"{text}, {missed}")
