# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""Patterns of topic names: `*` within one part, `**` for any number of parts."""

from __future__ import annotations

from collections.abc import Sequence
from fnmatch import fnmatchcase

_ANY_PARTS = "**"
_HIDDEN = "_"
# Topics of every node, which would be mixed up outside.
_OF_EVERY_NODE = ("/rosout", "/parameter_events")


def is_pattern(name: str) -> bool:
    """Return whether a name is a pattern."""
    return "*" in name


def matches(pattern: str, topic: str) -> bool:
    """Return whether a full name matches a pattern.

    A part that starts with `_` is hidden: it is only matched by a part that starts so as well. The
    topics of every node are never matched.

    >>> matches("/camera/*", "/camera/image"), matches("/camera/*", "/camera/left/image")
    (True, False)
    """
    if topic in _OF_EVERY_NODE:
        return False
    parts = pattern.split("/")[1:]
    places = _with_skips(parts, {0})
    for part in topic.split("/")[1:]:
        places = _with_skips(parts, {n for place in places for n in _next(parts, place, part)})
    return len(parts) in places


def _next(parts: Sequence[str], place: int, part: str) -> tuple[int, ...]:
    """Return the positions in a pattern after one more part of a name."""
    if place == len(parts):
        return ()
    if part.startswith(_HIDDEN) and not parts[place].startswith(_HIDDEN):
        return ()
    if parts[place] == _ANY_PARTS:
        return (place,)
    return (place + 1,) if fnmatchcase(part, parts[place]) else ()


def _with_skips(parts: Sequence[str], places: set[int]) -> set[int]:
    """Add the positions after each `**`, which may match nothing."""
    reached = set(places)
    for place in sorted(places):
        while place < len(parts) and parts[place] == _ANY_PARTS:
            place += 1
            reached.add(place)
    return reached
