# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""Stores the output of a run and its nodes for `manycore logs`."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from pathlib import Path

from rmw_manycore_py.launch.event_text import text_of
from rmw_manycore_py.launch.events import Ended, Event, Notice, Output
from rmw_manycore_py.launch.runs.log_file import RUN_LOG, LogFile, share_of


class LogKeeper:
    """Writes a log file per node, and one of the run; a full disk costs lines, never the run.

    :param warn: called once per node whose lines cannot be stored.
    :param changed: called after each line.
    """

    def __init__(
        self,
        directory: Path,
        nodes: Sequence[str],
        warn: Callable[[Event], None],
        changed: Callable[[], None],
    ) -> None:
        self._directory = directory
        self._max_bytes = share_of(1 + len(nodes))
        self._files: dict[str, LogFile] = {}
        self._warn = warn
        self._changed = changed

    def report(self, event: Event) -> None:
        """Store the text of an event, if it has any."""
        if isinstance(event, Output):
            self._write(event.node, event.line)
        elif (text := text_of(event)) is not None:
            self._write(RUN_LOG, text)
            if isinstance(event, Ended):
                for line in event.last_lines:
                    self._write(RUN_LOG, f"    {line}")

    def close(self) -> None:
        """Close all files."""
        for file in self._files.values():
            file.close()

    def _write(self, name: str, line: str) -> None:
        if name not in self._files:
            self._files[name] = LogFile(self._directory, name, self._max_bytes)
        if reason := self._files[name].write(line):
            self._warn(Notice(f"cannot write the log of {name}: {reason}"))
        self._changed()
