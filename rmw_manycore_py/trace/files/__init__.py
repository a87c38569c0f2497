# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""Trace files: `.json` for Chrome and Perfetto, `.csv`, and Perfetto's protobuf."""

from __future__ import annotations

from pathlib import Path

from rmw_manycore_py.errors import ManycoreError
from rmw_manycore_py.trace.atomic_file import atomic_write
from rmw_manycore_py.trace.events import Trace
from rmw_manycore_py.trace.files import chrome, perfetto, table


def save(trace: Trace, path: Path) -> None:
    """Write a trace in the format of the suffix. Replaces an existing file only when complete.

    :raises ManycoreError: if the file cannot be written.
    """
    try:
        with atomic_write(path) as file:
            if path.suffix == ".json":
                chrome.write(trace, file)
            elif path.suffix == ".csv":
                table.write(trace, file)
            else:
                perfetto.write(trace, file)
    except OSError as error:
        raise ManycoreError(f"{path}: cannot be written: {error.strerror or error}") from error


def load(path: Path) -> Trace:
    """Read a saved trace.

    :raises ManycoreError: if it cannot be read; FileError if it is no trace.
    """
    try:
        content = path.read_bytes()
    except OSError as error:
        raise ManycoreError(f"{path}: cannot be read: {error.strerror or error}") from error
    if path.suffix == ".csv":
        return table.read(content, path)
    if path.suffix == ".json":
        return chrome.read(content, path)
    return perfetto.read(content, path)
