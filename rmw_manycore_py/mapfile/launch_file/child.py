# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""Programs run by launch files for their output, with limits on time and output."""

from __future__ import annotations

import os
import selectors
import signal
import subprocess
import tempfile
import time
from collections.abc import Mapping, Sequence
from dataclasses import dataclass

from rmw_manycore_py.mapfile.format.bounded_yaml import MAX_BYTES
from rmw_manycore_py.process.parent_death import dies_with_this_process

_READ_BYTES = 1 << 16


class ChildBoundError(Exception):
    """The program exceeds its time or output limit."""


@dataclass(frozen=True)
class Finished:
    """Result of a program; a negative `returncode` is the signal that ended it."""

    returncode: int
    stdout: str
    stderr: str


def run_child(
    words: Sequence[str],
    environment: Mapping[str, str],
    timeout_s: float,
    given: bytes = b"",
    *,
    captures_stderr: bool = False,
) -> Finished:
    """Run a program with `given` on standard input; kill it and its children at a limit.

    :param captures_stderr: whether `stdout` of the result includes standard error.
    """
    with tempfile.TemporaryFile() as stdin:
        stdin.write(given)
        stdin.seek(0)
        child = subprocess.Popen(
            words,
            env=environment,
            stdin=stdin,
            stdout=subprocess.PIPE,
            stderr=subprocess.STDOUT if captures_stderr else subprocess.PIPE,
            start_new_session=True,
            preexec_fn=dies_with_this_process(),
        )
    with child:
        try:
            stdout, stderr = _output(child, time.monotonic() + timeout_s, timeout_s)
            return Finished(child.returncode, stdout.decode(), stderr.decode(errors="replace"))
        finally:
            if child.poll() is None:
                os.killpg(child.pid, signal.SIGKILL)


def _output(child: subprocess.Popen[bytes], end_s: float, timeout_s: float) -> tuple[bytes, bytes]:
    """Return the output of a program after its end."""
    assert child.stdout is not None
    read = {pipe: b"" for pipe in (child.stdout, child.stderr) if pipe is not None}
    with selectors.DefaultSelector() as selector:
        for pipe in read:
            selector.register(pipe, selectors.EVENT_READ, pipe)
        while selector.get_map():
            ready = selector.select(max(0.0, end_s - time.monotonic()))
            if not ready:
                raise ChildBoundError(f"no end after {timeout_s:g} s")
            for key, _ in ready:
                pipe = key.data
                piece = os.read(pipe.fileno(), _READ_BYTES)
                read[pipe] += piece
                if not piece:
                    selector.unregister(pipe)
                if len(read[pipe]) > MAX_BYTES:
                    raise ChildBoundError(f"more than {MAX_BYTES} bytes of output")
    try:
        child.wait(max(0.0, end_s - time.monotonic()))
    except subprocess.TimeoutExpired:
        raise ChildBoundError(f"no end after {timeout_s:g} s") from None
    return read[child.stdout], b"" if child.stderr is None else read[child.stderr]
