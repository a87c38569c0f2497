# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""Sizes, counts and lists in words."""

from __future__ import annotations

from collections.abc import Sequence


def size_text(size_bytes: int) -> str:
    """Format a number of bytes with a binary unit: 4 MiB."""
    for unit, shift in (("GiB", 30), ("MiB", 20), ("KiB", 10)):
        if size_bytes >= 1 << shift:
            return f"{size_bytes / (1 << shift):.4g} {unit}"
    return f"{size_bytes} B"


def counted(number: int, noun: str) -> str:
    """Format a count with its noun: 1 node, 2 nodes."""
    return f"{number} {noun}" if number == 1 else f"{number} {noun}s"


def listed(names: Sequence[str], limit: int | None = None) -> str:
    """Format a list: a, b and c; beyond a limit: a, b and 7 more."""
    if limit is not None and len(names) > limit:
        names = [*names[: limit - 1], f"{len(names) - limit + 1} more"]
    return " and ".join([", ".join(names[:-1]), *names[-1:]] if len(names) > 1 else names)
