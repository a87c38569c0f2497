# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""Calls code of launch files; errors name the file and line."""

from __future__ import annotations

import traceback
from pathlib import Path
from typing import Any

from rmw_manycore_py.errors import ManycoreError, MapfileError, Problem
from rmw_manycore_py.mapfile.launch_file.refusals import LaunchFileError, UnavailableError
from rmw_manycore_py.mapfile.launch_file.unavailable import error_in


def guarded(path: Path, function: Any, *arguments: Any, **named: Any) -> Any:
    """Call code of a launch file; convert any exception to an error in that file.

    :raises UnavailableError: if the code depends on something missing here.
    """
    try:
        return function(*arguments, **named)
    except (ManycoreError, KeyboardInterrupt):
        raise
    except BaseException as error:
        missing = error if isinstance(error, UnavailableError) else error_in(_text(error))
        if missing is None:
            raise failure(path, error) from error
        missing.place = missing.place or (path, _line(path, error))
        raise missing from error


def failure(path: Path, error: BaseException, near_line: int = 0) -> MapfileError:
    """Return the MapfileError for an exception in a launch file, with its line."""
    line = _line(path, error) or near_line
    if isinstance(error, LaunchFileError):
        return MapfileError(error.at(path, line))
    text = _text(error)
    found = f"{type(error).__name__}: {text}" if text else type(error).__name__
    return MapfileError(Problem(path, line, "", "launch code that is understood here", found))


def _line(path: Path, error: BaseException) -> int:
    frames = traceback.extract_tb(error.__traceback__)
    lines = [frame.lineno or 0 for frame in frames if frame.filename == str(path)]
    return lines[-1] if lines else getattr(error, "lineno", None) or 0


def _text(error: BaseException) -> str:
    if isinstance(error, SyntaxError):
        return error.msg
    try:
        return str(error)
    except Exception:  # raised by a class of the launch file
        return "it cannot be written out"
