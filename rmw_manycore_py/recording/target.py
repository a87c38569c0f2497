# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""Destination of a recording: a file, or a rosbag2 directory."""

from __future__ import annotations

import time
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from rmw_manycore_py.errors import EXIT_BAD_INPUT, ManycoreError
from rmw_manycore_py.recording.metadata import FILE_NAME, write_metadata

SUFFIX = ".mcap"


@dataclass(frozen=True)
class Target:
    """A file ending in .mcap, else a directory with such a file and metadata.yaml."""

    path: Path

    @property
    def is_folder(self) -> bool:
        """Return whether it is a directory."""
        return self.path.suffix != SUFFIX

    @property
    def file(self) -> Path:
        """Return the path of the MCAP file."""
        return self.path / f"{self.path.name}_0{SUFFIX}" if self.is_folder else self.path

    def prepare(self, *, force: bool) -> None:
        """Create the directory; with `force`, remove an existing recording.

        :raises ManycoreError: if the path exists, or cannot be written.
        """
        if self.path.is_symlink() or self.path.exists():
            if not force:
                raise ManycoreError(
                    f"{self.path}: already exists: choose another name, or --force to replace it",
                    EXIT_BAD_INPUT,
                )
            self._remove()
        try:
            if self.is_folder:
                self.path.mkdir()
        except OSError as error:
            raise ManycoreError(
                f"{self.path}: cannot be created: {error.strerror}", EXIT_BAD_INPUT
            ) from error

    def _remove(self) -> None:
        """Remove a recording, and nothing else."""
        files = [self.path]
        if self.path.is_dir():
            files = list(self.path.iterdir())
        strange = [f for f in files if f.suffix != SUFFIX and f.name != FILE_NAME]
        if strange or self.path.is_dir() != self.is_folder:
            raise ManycoreError(
                f"{self.path}: contains more than a recording, so --force does not replace it"
                + (f": found {strange[0].name}" if strange else ""),
                EXIT_BAD_INPUT,
            )
        try:
            for file in files:
                file.unlink()
            if self.is_folder:
                self.path.rmdir()
        except OSError as error:
            raise ManycoreError(f"{self.path}: cannot be removed: {error.strerror}") from error

    def describe(self, found: dict[str, Any]) -> None:
        """Write rosbag2's metadata of a finished recording.

        :raises ManycoreError: if it cannot be written; the recording is complete without it.
        """
        try:
            if self.is_folder:
                write_metadata(self.path, found)
        except OSError as error:
            raise ManycoreError(
                f"{self.path / FILE_NAME}: cannot be written: {error.strerror}; {self.file} is "
                "complete"
            ) from error


def default_target() -> Path:
    """Return the default name used by `ros2 bag record`."""
    return Path(time.strftime("rosbag2_%Y_%m_%d-%H_%M_%S"))
