# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""Short number formats."""

from __future__ import annotations


def rate_text(rate_hz: float) -> str:
    """Format a rate: 9.9 Hz."""
    return f"{_short(rate_hz)} Hz" if rate_hz < 1000 else f"{_short(rate_hz / 1000)} kHz"


def bytes_text(size_bytes: float) -> str:
    """Format a size: 1.4 MiB."""
    for unit, shift in (("GiB", 30), ("MiB", 20), ("KiB", 10)):
        if size_bytes >= 1 << shift:
            return f"{_short(size_bytes / (1 << shift))} {unit}"
    return f"{size_bytes:.0f} B"


def time_text(time_us: float) -> str:
    """Format a duration: 85 us."""
    for unit, size in (("s", 1e6), ("ms", 1e3)):
        if time_us >= size:
            return f"{_short(time_us / size)} {unit}"
    return f"{_short(time_us)} us"


def percent_text(share: float) -> str:
    """Format a share of one CPU: 12 %."""
    return f"{100 * share:.0f} %"


# Mean width of characters in DejaVu Sans, a wide font: 11 px, the same in bold, 10 px.
PLAIN, BOLD, SMALL = 6.7, 7.6, 6.1


def width_of(text: str, character: float) -> float:
    """Return the width of a text, in pixels."""
    return len(text) * character


def fitted(text: str, width: float, character: float = PLAIN) -> str:
    """Truncate a name to a width, keeping its last part."""
    room = max(int(width / character), 2)
    if len(text) <= room:
        return text
    last = text.rpartition("/")[2]
    return f"…{last}" if len(last) < room else f"{last[: room - 1]}…"


def _short(value: float) -> str:
    # From 99.5 on, two digits would be 1e+02.
    return f"{value:.0f}" if value >= 99.5 or value == 0 else f"{value:.2g}"
