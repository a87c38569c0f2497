# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""Patterns of topic names: `*` within a part of a name, `**` for any number of parts."""

from __future__ import annotations

from collections.abc import Sequence
from fnmatch import fnmatchcase

_ANY_PARTS = "**"
_HIDDEN = "_"
# Every node has these; outside they would mix with those of other programs.
_OF_EVERY_NODE = ("/rosout", "/parameter_events")


def is_pattern(name: str) -> bool:
    """Tell whether a name stands for several topics."""
    return "*" in name


def matches(pattern: str, topic: str) -> bool:
    """Tell whether a full name fits a pattern.

    A part that begins with `_` is hidden: only a part of the pattern that begins so fits it. What
    every node publishes fits no pattern.

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
    """Return where a pattern goes on after one more part of a name."""
    if place == len(parts):
        return ()
    if part.startswith(_HIDDEN) and not parts[place].startswith(_HIDDEN):
        return ()
    if parts[place] == _ANY_PARTS:
        return (place,)
    return (place + 1,) if fnmatchcase(part, parts[place]) else ()


def _with_skips(parts: Sequence[str], places: set[int]) -> set[int]:
    """Add the places after each `**`, which may stand for nothing."""
    reached = set(places)
    for place in sorted(places):
        while place < len(parts) and parts[place] == _ANY_PARTS:
            place += 1
            reached.add(place)
    return reached
