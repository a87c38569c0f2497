# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""Errors reported to the user, each with the exit status of the command line."""

from __future__ import annotations

import errno
import re
from collections.abc import Iterable
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from pydantic import ValidationError

EXIT_FAILURE = 1
EXIT_BAD_INPUT = 2
EXIT_INTERRUPTED = 130  # as the shell reports a program that SIGINT ended


class ManycoreError(Exception):
    """Base of all errors that are reported to the user without a traceback."""

    def __init__(self, message: str, exit_status: int = EXIT_FAILURE) -> None:
        super().__init__(message)
        self.exit_status = exit_status


_MAX_KEY, _MAX_EXPECTED, _MAX_FOUND = 100, 500, 200


def shorten(text: str, limit: int | None = None) -> str:
    """Return a text for use within one line: control characters escaped, truncated."""
    kept = text if limit is None else text[: limit + 1]
    line = "".join(c if c.isprintable() else c.encode("unicode_escape").decode() for c in kept)
    return line if limit is None or len(line) <= limit else f"{line[: limit - 3]}..."


@dataclass(frozen=True)
class Problem:
    """One problem in a file, on one line; `line` counts from 1, 0 means the whole file."""

    file: Path
    line: int
    key: str
    expected: str
    found: str

    def __post_init__(self) -> None:
        limits = {"key": _MAX_KEY, "expected": _MAX_EXPECTED, "found": _MAX_FOUND}
        for name, limit in limits.items():
            object.__setattr__(self, name, shorten(getattr(self, name), limit))

    def __str__(self) -> str:
        file = shorten(str(self.file))
        place = f"{file}:{self.line}" if self.line else file
        key = f" {self.key}:" if self.key else ""
        return f"{place}:{key} expected {self.expected}, found {self.found}"


class FileError(ManycoreError):
    """All problems in files of the user, in line order.

    :ivar hints: what helps, one line each, behind the problems in the text.
    """

    def __init__(self, *problems: Problem, hints: Iterable[str] = ()) -> None:
        self.problems = tuple(sorted(problems, key=lambda p: (str(p.file), p.line)))
        self.hints = tuple(hints)
        super().__init__("\n".join([*map(str, self.problems), *self.hints]), EXIT_BAD_INPUT)


class MapfileError(FileError):
    """All problems in a mapfile or a file it refers to."""


class DefinitionError(FileError):
    """All problems in definitions of messages, services and actions."""


# By name: the native modules may be missing, and rclpy is loaded late.
_REPORTED = {
    "rmw_manycore_py.native._transport.PlatformError",
    "rmw_manycore_py.native._ndt.NdtError",
    "rclpy._rclpy_pybind11.RCLError",
    "rclpy.exceptions.NameValidationException",
}
_WRITE_ERRORS = (errno.ENOSPC, errno.EDQUOT, errno.EFBIG, errno.EIO)
_C_PLACE = re.compile(r", at \S+:\d+.*", re.DOTALL)


def reported(error: Exception) -> ManycoreError | None:
    """Return what a command reports of an error, instead of a traceback; None for a bug.

    Errors of the transport, of rcl and of the operating system have causes outside the program.
    """
    if isinstance(error, ManycoreError):
        return error
    if isinstance(error, OSError):
        text = error.strerror or str(error)
        is_write = error.errno in _WRITE_ERRORS
        place = error.filename or ("the output cannot be written" if is_write else "")
        return ManycoreError(f"{place}: {text}" if place else text)
    names = {f"{kind.__module__}.{kind.__qualname__}" for kind in type(error).__mro__}
    if names & _REPORTED or isinstance(error, MemoryError):
        return ManycoreError(_C_PLACE.sub("", what_is_wrong(error)))
    return None


def what_is_wrong(error: Exception) -> str:
    """Return the message of an error, or its class name if the message is empty."""
    return str(error) or type(error).__name__


def invalid_field(error: ValidationError) -> tuple[str, str]:
    """Return the first invalid key, such as `nodes.0.name`, and its fault."""
    first = error.errors()[0]
    return ".".join(map(str, first["loc"])), first["msg"]
