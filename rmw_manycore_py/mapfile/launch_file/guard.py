# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""Calls code of launch files; errors name the file and line."""

from __future__ import annotations

import traceback
from pathlib import Path
from typing import Any

from rmw_manycore_py.errors import ManycoreError, MapfileError, Problem
from rmw_manycore_py.mapfile.launch_file.context import LaunchFileError


def guarded(path: Path, function: Any, *arguments: Any, **named: Any) -> Any:
    """Call code of a launch file; convert any exception to an error in that file."""
    try:
        return function(*arguments, **named)
    except (ManycoreError, KeyboardInterrupt):
        raise
    except BaseException as error:
        raise failure(path, error) from error


def failure(path: Path, error: BaseException, near_line: int = 0) -> MapfileError:
    """Return the MapfileError for an exception in a launch file, with its line."""
    frames = traceback.extract_tb(error.__traceback__)
    lines = [frame.lineno or 0 for frame in frames if frame.filename == str(path)]
    line = lines[-1] if lines else getattr(error, "lineno", None) or near_line
    if isinstance(error, LaunchFileError):
        return MapfileError(error.at(path, line))
    said = _said(error)
    found = f"{type(error).__name__}: {said}" if said else type(error).__name__
    return MapfileError(Problem(path, line, "", "launch code that is understood here", found))


def _said(error: BaseException) -> str:
    if isinstance(error, SyntaxError):
        return error.msg
    try:
        return str(error)
    except Exception:  # raised by a class of the launch file
        return "it cannot be written out"
