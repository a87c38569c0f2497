# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""The substitution that runs a command."""

from __future__ import annotations

import shlex
from typing import Any

from typing_extensions import override

from rmw_manycore_py.mapfile.launch_file.child import ChildBoundError, Finished, run_child
from rmw_manycore_py.mapfile.launch_file.context import LaunchContext
from rmw_manycore_py.mapfile.launch_file.refusals import LaunchFileError, UnavailableError
from rmw_manycore_py.mapfile.launch_file.substitution import Substitution, perform
from rmw_manycore_py.mapfile.launch_file.substitutions import quoted

TIMEOUT_S = 60
# What launch does with text on standard error.
_MODES = ("fail", "ignore", "warn", "capture")


class Command(Substitution):
    """`$(command 'line' mode)`: the output of a command."""

    def __init__(self, command: Any, *, on_stderr: Any = "fail") -> None:
        self.command, self.on_stderr = command, on_stderr

    @override
    def perform(self, context: LaunchContext) -> str:
        line, mode = perform(context, self.command), perform(context, self.on_stderr)
        if mode not in _MODES:
            raise LaunchFileError(f"on_stderr to be one of {', '.join(_MODES)}", f"'{mode}'")
        done = _run(context, line, captures=mode == "capture")
        if done.returncode != 0 or (done.stderr and mode == "fail"):
            output = (done.stderr or done.stdout).strip()
            raise UnavailableError("a command that succeeds", f"{quoted(line)}: {output}")
        if done.stderr and mode == "warn":
            context.notice(0, f"{quoted(line)} printed: {done.stderr.strip()}")
        return done.stdout


def _run(context: LaunchContext, line: str, *, captures: bool) -> Finished:
    try:
        words = shlex.split(line) or [""]
        return run_child(words, context.environment, TIMEOUT_S, captures_stderr=captures)
    except OSError as error:
        found = f"{quoted(line)}: {error.strerror}"
        raise UnavailableError("a command that runs", found) from error
    except (ChildBoundError, ValueError) as error:
        raise UnavailableError("a command that runs", f"{quoted(line)}: {error}") from error
