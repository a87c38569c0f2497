# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""Saves the rings of a platform to a file."""

from __future__ import annotations

from pathlib import Path

from rmw_manycore_py.errors import ManycoreError
from rmw_manycore_py.trace.events import Trace
from rmw_manycore_py.trace.files import save
from rmw_manycore_py.trace.recorded import recorded


def save_recorded(platform: str, path: Path) -> Trace:
    """Save the events recorded on a platform, free their rings, and return the trace.

    If all events were lost, the trace is saved with their number.

    :raises ManycoreError: if nothing was recorded, or the file cannot be written; the recorded
        events are then kept.
    """
    with recorded(platform) as trace:
        if not trace.event_count and not trace.lost:
            raise ManycoreError(
                f"platform {platform} has recorded nothing since the last trace was saved"
            )
        try:
            save(trace, path)
        except ManycoreError as error:
            raise ManycoreError(f"{error}; the trace is kept: save it elsewhere") from error
    return trace
