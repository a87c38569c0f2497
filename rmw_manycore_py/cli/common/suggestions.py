# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""What a user probably meant by a name that does not exist."""

from __future__ import annotations

import difflib
from collections.abc import Iterable

# Of difflib's ratio, from 0 for names that have nothing in common to 1 for equal ones.
_ALIKE = 0.6


def closest(name: str, known: Iterable[str]) -> str | None:
    """Return the known name that is most like this one, unless none is.

    The last parts have to be alike, too: all types of a package begin alike.
    """
    by_folded = {candidate.casefold(): candidate for candidate in known}
    folded = name.casefold()
    for close in difflib.get_close_matches(folded, by_folded, cutoff=_ALIKE):
        last_parts = folded.rpartition("/")[2], close.rpartition("/")[2]
        if difflib.SequenceMatcher(None, *last_parts).ratio() >= _ALIKE:
            return by_folded[close]
    return None


def did_you_mean(name: str, known: Iterable[str]) -> str:
    """Return the end of an error about an unknown name: "; did you mean 'x'?", or nothing."""
    meant = closest(name, known)
    return f"; did you mean '{meant}'?" if meant else ""
