# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""From the rings of a platform into a file."""

from __future__ import annotations

from pathlib import Path

from rmw_manycore_py.errors import ManycoreError
from rmw_manycore_py.trace.events import Trace
from rmw_manycore_py.trace.files import save
from rmw_manycore_py.trace.recorded import recorded


def save_recorded(platform: str, path: Path) -> Trace:
    """Save what a platform has recorded, give its room back, and return it.

    A trace whose events were all lost is saved, too: it says how many they were.

    :raises ManycoreError: where nothing was recorded, or the file cannot be written; what was
        recorded is then kept.
    """
    with recorded(platform) as trace:
        if not trace.event_count and not trace.lost:
            raise ManycoreError(
                f"platform {platform} has recorded nothing since its last trace was saved"
            )
        save(trace, path)
    return trace
