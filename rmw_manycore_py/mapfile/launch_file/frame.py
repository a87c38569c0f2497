# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""Where the code of a launch file calls from."""

from __future__ import annotations

import ast
import sys
from functools import cache
from pathlib import Path
from types import FrameType

# `__name__` of the code of Python launch files.
MODULE_NAME = "launch_file"
_HERE = str(Path(__file__).parent)
_IMPORT_SYSTEM = "<frozen importlib"


def calling_frame() -> FrameType:
    """Return the frame that called into this package, past Python's import system."""
    frame = sys._getframe(1)
    while frame.f_back is not None and frame.f_code.co_filename.startswith((_HERE, _IMPORT_SYSTEM)):
        frame = frame.f_back
    return frame


def calling_line() -> int:
    """Return the line of the Python launch file that creates an action."""
    return calling_frame().f_lineno


def is_launch_file(frame: FrameType) -> bool:
    """Return whether code of a launch file runs in a frame."""
    return frame.f_globals.get("__name__") == MODULE_NAME


def is_in_try(frame: FrameType) -> bool:
    """Return whether a frame is in the body of a `try`: the code handles the error."""
    line = frame.f_lineno
    return any(first <= line <= last for first, last in _tries(frame.f_code.co_filename))


@cache
def _tries(file: str) -> list[tuple[int, int]]:
    """Return the first and last lines of the bodies of `try` that handle exceptions."""
    try:
        tree = ast.parse(Path(file).read_bytes())
    except (OSError, ValueError, SyntaxError, RecursionError, MemoryError):
        return []
    return [
        (node.body[0].lineno, node.body[-1].end_lineno or 0)
        for node in ast.walk(tree)
        if isinstance(node, ast.Try) and node.handlers
    ]
