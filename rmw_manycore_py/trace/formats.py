# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""Formats of trace files: known to commands without the numpy of those who write them."""

from __future__ import annotations

from pathlib import Path

from rmw_manycore_py.errors import missing_library

PERFETTO = (".pftrace", ".perfetto-trace")
SUFFIXES = (".json", ".csv", *PERFETTO)


def require_format(path: Path) -> None:
    """Raise ManycoreError if what writes a file of this suffix is missing: before the events."""
    if path.suffix in PERFETTO:
        missing_library.require(missing_library.PERFETTO)
