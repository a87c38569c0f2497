# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""Suggestions for mistyped names."""

from __future__ import annotations

import difflib
from collections.abc import Iterable

# Minimum ratio of difflib: 0 = nothing in common, 1 = equal.
_ALIKE = 0.6


def closest(name: str, known: Iterable[str]) -> str | None:
    """Return the known name closest to this one, or None if none is similar.

    The last parts have to be similar as well, since all types of a package share their prefix.
    """
    by_folded = {candidate.casefold(): candidate for candidate in known}
    folded = name.casefold()
    for close in difflib.get_close_matches(folded, by_folded, cutoff=_ALIKE):
        last_parts = folded.rpartition("/")[2], close.rpartition("/")[2]
        if difflib.SequenceMatcher(None, *last_parts).ratio() >= _ALIKE:
            return by_folded[close]
    return None


def did_you_mean(name: str, known: Iterable[str]) -> str:
    """Return "; did you mean 'x'?" for an unknown name, or an empty string."""
    meant = closest(name, known)
    return f"; did you mean '{meant}'?" if meant else ""
