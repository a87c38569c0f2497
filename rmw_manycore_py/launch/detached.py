# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""Run in the background: its supervisor is a child process that outlives the shell."""

from __future__ import annotations

import json
import os
import signal
import sys
from contextlib import suppress
from typing import IO

from rmw_manycore_py.errors import EXIT_FAILURE, EXIT_INTERRUPTED, ManycoreError, reported
from rmw_manycore_py.launch.events import Event, Output, event_of
from rmw_manycore_py.launch.run import Run
from rmw_manycore_py.launch.runner import Report

_ERROR = "error"


def run_in_background(run: Run, report: Report) -> int:
    """Start a run in a child process, report until its nodes are started; return the exit status.

    Ctrl-C before that stops the run.
    """
    reader, writer = os.pipe()
    sys.stdout.flush()
    sys.stderr.flush()
    pid = os.fork()  # safe: single-threaded, and no platform is open yet
    if pid == 0:
        os.close(reader)
        _be_supervisor(run, writer)
    os.close(writer)
    with os.fdopen(reader, "rb") as events:
        return _until_started(pid, events, report)


def _until_started(pid: int, events: IO[bytes], report: Report) -> int:
    is_interrupted = False
    while True:
        try:
            is_up = _pass_on(events, report)
            break
        except KeyboardInterrupt:
            is_interrupted = True
            with suppress(ProcessLookupError):
                os.kill(pid, signal.SIGTERM)
    if is_up and not is_interrupted:
        return 0
    _, status = os.waitpid(pid, 0)
    return EXIT_INTERRUPTED if is_interrupted else os.waitstatus_to_exitcode(status) or 0


def _pass_on(events: IO[bytes], report: Report) -> bool:
    """Report the supervisor's events; return whether it came up before its pipe closed."""
    for line in events:
        data = json.loads(line)
        if data.get("event") == "up":
            return True
        if _ERROR in data:
            raise ManycoreError(data[_ERROR], data["exit_status"])
        event = event_of(data)
        if event is not None:
            report(event)
    return False


def _be_supervisor(run: Run, writer: int) -> None:
    """Run in a session of its own; never return."""
    status = EXIT_FAILURE
    try:
        os.setsid()
        _leave_streams()
        progress = _Progress(writer)
        try:
            status = run.run(progress.report, all_started=progress.come_up)
        except Exception as error:
            known = reported(error) or ManycoreError(f"{type(error).__name__}: {error}")
            status = known.exit_status
            progress.send({_ERROR: str(known), "exit_status": status})
    finally:
        os._exit(status)


def _leave_streams() -> None:
    """Close the shell's terminal and pipes: their readers wait for all writers to close."""
    null = os.open(os.devnull, os.O_RDWR)
    for descriptor in (0, 1, 2):
        os.dup2(null, descriptor)
    os.close(null)


class _Progress:
    """Sends progress to the foreground process until all nodes have been started."""

    def __init__(self, descriptor: int) -> None:
        self._descriptor = descriptor

    def report(self, event: Event) -> None:
        """Send an event, except node output."""
        if not isinstance(event, Output):
            self.send(event.as_data())

    def come_up(self) -> None:
        """Send that the run is up, and stop sending."""
        self.send({"event": "up"})
        if self._descriptor >= 0:
            os.close(self._descriptor)
            self._descriptor = -1

    def send(self, data: object) -> None:
        """Send a message; the run continues if the reader has gone."""
        with suppress(OSError):
            if self._descriptor >= 0:
                os.write(self._descriptor, json.dumps(data).encode() + b"\n")
