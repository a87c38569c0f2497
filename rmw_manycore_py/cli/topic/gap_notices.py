# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""Notices of long gaps in a recording that is to be played."""

from __future__ import annotations

from collections.abc import Iterator

from rmw_manycore_py.recording.recording import Recording

_NS_PER_S = 1_000_000_000
MIN_GAP_NS = 3600 * _NS_PER_S
_MAX_NOTICES = 3
_UNITS = ((365.25 * 86400, "years"), (86400.0, "days"), (3600.0, "hours"))


def gap_notices(recording: Recording, start_ns: int, end_ns: int) -> Iterator[str]:
    """Yield a notice for each long gap between two times, with the options that skip it."""
    gaps = [g for g in recording.gaps(MIN_GAP_NS) if start_ns <= g.start_ns and g.end_ns <= end_ns]
    for gap in gaps[:_MAX_NOTICES]:
        before_s, after_s = (
            (time_ns - recording.span.start_ns) / _NS_PER_S
            for time_ns in (gap.start_ns, gap.end_ns)
        )
        yield (
            f"{recording.path}: no message for {_length(after_s - before_s)} after "
            f"{before_s:.3f} s: playing waits as long; --duration {before_s:.3f} ends before it, "
            f"--start-offset {after_s:.3f} begins after it"
        )
    if len(gaps) > _MAX_NOTICES:
        yield f"{recording.path}: {len(gaps) - _MAX_NOTICES} more such gaps"


def _length(duration_s: float) -> str:
    unit_s, name = next((u for u in _UNITS if duration_s >= u[0]), _UNITS[-1])
    return f"{duration_s / unit_s:.1f} {name}"
