# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""Progress of a drive: one updating line on a terminal, else occasional lines."""

from __future__ import annotations

import time

from rich.console import Console

from rmw_manycore_py.papers.roslite2.laptop.drive_log import DriveLog

PERIOD_S = 2.0
TERMINAL_PERIOD_S = 0.2


class DriveProgress:
    """Writes to standard error."""

    def __init__(self) -> None:
        self._console = Console(stderr=True)
        self._status = self._console.status("waiting for the stack")
        self._said_s = time.monotonic()
        self._is_live = self._console.is_terminal
        self._incidents = 0

    def __enter__(self) -> DriveProgress:
        if self._is_live:
            self._status.start()
        return self

    def __exit__(self, *_: object) -> None:
        self._status.stop()

    def report(self, log: DriveLog) -> None:
        """Show new incidents, and the position of the vehicle."""
        for incident in log.incidents[self._incidents :]:  # other threads may append
            self._print(incident.text)
            self._incidents += 1
        period_s = TERMINAL_PERIOD_S if self._is_live else PERIOD_S
        if time.monotonic() - self._said_s < period_s:
            return
        self._said_s = time.monotonic()
        if self._is_live:
            self._status.update(_text(log))
        else:
            self._print(_text(log))

    def _print(self, text: str) -> None:
        self._console.print(text, highlight=False, markup=False, soft_wrap=True)


def _text(log: DriveLog) -> str:
    if log.start_s() is None:
        return "waiting for the first command to drive"
    moment = log.moments[-1]
    return (
        f"{moment.along_m:.0f} of {log.course_m:.0f} m at {moment.speed_m_s:.2f} m/s, "
        f"{abs(moment.lateral_m):.2f} m off, {len(log.scans)} scans"
    )
