# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""Reads a launch file in a child process: its code may end the process that runs it."""

from __future__ import annotations

import io
import os
import pickle
import signal
import sys
import traceback
import warnings
from collections.abc import Callable, Mapping
from contextlib import suppress
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any, BinaryIO, NoReturn, TypeVar

from typing_extensions import override

from rmw_manycore_py.errors import FileError, MapfileError, Problem
from rmw_manycore_py.mapfile.launch_file.guard import failure
from rmw_manycore_py.process.parent_death import dies_with_this_process

Content = TypeVar("Content")


@dataclass(frozen=True)
class _Answer:
    """What was read, or why nothing was."""

    content: Any = None
    problems: tuple[Problem, ...] = ()
    environment: Mapping[str, str] = field(default_factory=dict)


def read_in_child(file: Path, read: Callable[[], Content]) -> Content:
    """Return the result of `read`, and set the environment variables that it sets.

    :raises MapfileError: if `read` does, or if its process ends.
    """
    sys.stdout.flush()  # else the child would print it again
    sys.stderr.flush()
    dies = dies_with_this_process()
    # A file: a pipe has no end as long as a process that the launch file forks keeps it open.
    with open(os.memfd_create("launch_file"), "w+b") as answers:
        with warnings.catch_warnings():  # the child needs nothing that another thread may hold
            warnings.simplefilter("ignore", DeprecationWarning)
            pid = os.fork()
        if pid == 0:
            dies()
            _run(file, read, answers)
        status = _status(pid)
        answers.seek(0)
        data = answers.read()
    if status != 0 or not data:
        raise MapfileError(Problem(file, 0, "", "launch code that returns", _ending(status)))
    answer: _Answer = pickle.loads(data)
    if answer.problems:
        raise MapfileError(*answer.problems)
    _set_environment(answer.environment)
    content: Content = answer.content
    return content


def _status(pid: int) -> int:
    """Wait for the child; Ctrl-C kills it."""
    try:
        return os.waitpid(pid, 0)[1]
    except BaseException:
        with suppress(ProcessLookupError, ChildProcessError):  # it has ended already
            os.kill(pid, signal.SIGKILL)
            os.waitpid(pid, 0)
        raise


def _run(file: Path, read: Callable[[], Any], answers: BinaryIO) -> NoReturn:
    status = 1
    try:
        _read_nothing_from_stdin()
        data = _read(file, read)
        sys.stdout.flush()
        answers.write(data)
        answers.flush()
        status = 0
    except Exception:
        traceback.print_exc()
    finally:
        os._exit(status)  # nothing of the parent is cleaned up twice


def _read_nothing_from_stdin() -> None:
    """Replace the user's terminal by an empty input."""
    with open(os.devnull) as nothing:
        os.dup2(nothing.fileno(), 0)
    sys.stdin = open(0, closefd=False)  # noqa: SIM115  # until the process ends


def _read(file: Path, read: Callable[[], Any]) -> bytes:
    try:
        content = read()
    except FileError as error:
        return pickle.dumps(_Answer(problems=error.problems))
    data = io.BytesIO()
    try:
        _Pickler(data).dump(_Answer(content, environment=dict(os.environ)))
    except Exception as error:  # a value that only the code of the launch file knows
        return pickle.dumps(_Answer(problems=failure(file, error).problems))
    return data.getvalue()


class _Pickler(pickle.Pickler):
    """Passes on texts and numbers of classes of the launch file as plain ones."""

    @override
    def reducer_override(self, obj: Any) -> Any:
        for kind in (str, int, float):
            if isinstance(obj, kind):
                return kind, (kind.__str__(obj) if kind is str else kind(obj),)
        return NotImplemented


def _set_environment(environment: Mapping[str, str]) -> None:
    for name in os.environ.keys() - environment.keys():
        del os.environ[name]
    os.environ.update({n: v for n, v in environment.items() if os.environ.get(n) != v})


def _ending(status: int) -> str:
    code = os.waitstatus_to_exitcode(status)
    if code < 0:
        return f"that it was killed by {signal.Signals(-code).name}"
    return f"that it ended the process that reads it, with exit status {code}"
