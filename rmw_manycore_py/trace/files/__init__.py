# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""Saved traces: `.json` for Chrome and Perfetto, `.csv`, Perfetto's protobuf."""

from __future__ import annotations

import os
import tempfile
from pathlib import Path

from rmw_manycore_py.errors import ManycoreError
from rmw_manycore_py.trace.events import Trace
from rmw_manycore_py.trace.files import chrome, perfetto, table

PERFETTO = (".pftrace", ".perfetto-trace")
SUFFIXES = (".json", ".csv", *PERFETTO)


def save(trace: Trace, path: Path) -> None:
    """Write a trace as the suffix says. A file that was there stays until all is written.

    :raises ManycoreError: where the file cannot be written.
    """
    try:
        descriptor, name = tempfile.mkstemp(dir=path.parent, prefix=f".{path.name}.")
    except OSError as error:
        raise _unwritable(path, error) from error
    written = Path(name)
    try:
        with open(descriptor, "wb") as file:
            if path.suffix == ".json":
                chrome.write(trace, file)
            elif path.suffix == ".csv":
                table.write(trace, file)
            else:
                perfetto.write(trace, file)
            file.flush()
            os.fsync(file.fileno())
        written.replace(path)
    except OSError as error:
        raise _unwritable(path, error) from error
    finally:
        written.unlink(missing_ok=True)


def load(path: Path) -> Trace:
    """Read a trace that was saved.

    :raises ManycoreError: where there is none; FileError: where it is not one.
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


def _unwritable(path: Path, error: OSError) -> ManycoreError:
    return ManycoreError(
        f"{path}: cannot be written: {error.strerror or error}; "
        "the trace is kept: save it elsewhere"
    )
