# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""Runs of `manycore up -d`, which end with the test."""

from __future__ import annotations

import os
import signal
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from pathlib import Path

from rmw_manycore_py.launch.runs.directory import runs_of
from support.peers.programs import forked_manycore
from support.processes.commands import manycore_command
from support.processes.program import Program


@contextmanager
def background_runs(
    start: Callable[..., Program], platform: str
) -> Iterator[Callable[..., Program]]:
    """Yield a function that runs `manycore`, checks its status and returns the program.

    What goes on in the background is started as users start it; what changes a run is forked.
    """

    def begins(words: tuple[str | Path, ...]) -> bool:
        if words[0] != "up":
            return False
        return "--join" in words or not any(run.is_alive for run in runs_of(platform))

    def call(*words: str | Path, status: int = 0) -> Program:
        program = start((manycore_command if begins(words) else forked_manycore)(*words))
        assert program.wait() == status, program
        return program

    yield call
    for run in runs_of(platform):
        if run.is_alive:
            os.kill(run.info["pid"], signal.SIGKILL)
            run.wait()
