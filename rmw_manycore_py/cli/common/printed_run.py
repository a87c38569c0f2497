# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""A run whose output may be piped to a program that ends first, as in `... | grep -q`."""

from __future__ import annotations

import os
import sys
from typing import Any

from rmw_manycore_py.launch.events import Event, Finished
from rmw_manycore_py.launch.run import Run
from rmw_manycore_py.launch.runner import Report


def print_run(run: Run, report: Report, *arguments: Any, **options: Any) -> int:
    """Run with these arguments of `Run.run`; return the exit status.

    When the reader of standard output has gone, the run ends as on Ctrl-C, and what it prints then
    is discarded. So a reader that has found what it looks for leaves a status of success.
    """
    is_closed = False

    def report_to_reader(event: Event) -> None:
        nonlocal is_closed
        try:
            report(event)
        except BrokenPipeError:
            is_closed = True
            _discard_output()
            if not isinstance(event, Finished):
                raise  # ends the run

    try:
        return run.run(report_to_reader, *arguments, **options)
    except BrokenPipeError:
        if not is_closed:
            raise
        return 0  # no node was started yet, or all have ended


def _discard_output() -> None:
    null = os.open(os.devnull, os.O_WRONLY)
    os.dup2(null, sys.stdout.fileno())
    os.close(null)
