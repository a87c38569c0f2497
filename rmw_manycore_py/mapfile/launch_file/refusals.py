# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""Errors of launch files, and of what this machine lacks for them."""

from __future__ import annotations

from pathlib import Path

from rmw_manycore_py.errors import Problem


class LaunchFileError(Exception):
    """Unsupported or invalid content of a launch file; the action adds file and line."""

    def __init__(self, expected: str, found: str, key: str = "") -> None:
        super().__init__(f"expected {expected}, found {found}")
        self.expected, self.found, self.key = expected, found, key
        self.place: tuple[Path, int] | None = None  # of the code that raised it, where known

    def at(self, file: Path, line: int) -> Problem:
        """Return the Problem at a file and line."""
        return Problem(*(self.place or (file, line)), self.key, self.expected, self.found)


class UnavailableError(LaunchFileError):
    """A package, program or file is missing or fails here; only affects what uses it."""
