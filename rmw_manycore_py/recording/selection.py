# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""Selects the topics to record or play."""

from __future__ import annotations

import re
from dataclasses import dataclass

from rmw_manycore_py.ros.names import is_hidden
from rmw_manycore_py.ros.patterns import is_pattern, matches


@dataclass(frozen=True)
class Selection:
    """Topics by names and patterns, regular expression, types, or all; minus exclusions.

    Hidden topics (a part starts with `_`) are only selected by exact name, unless `hidden`.
    """

    names: tuple[str, ...] = ()  # full names, and patterns with * and **
    regex: re.Pattern[str] | None = None
    types: tuple[str, ...] = ()
    all: bool = False
    excluded: tuple[str, ...] = ()  # names and patterns
    exclude_regex: re.Pattern[str] | None = None
    hidden: bool = False

    @property
    def plain_names(self) -> tuple[str, ...]:
        """Return the names that are no patterns."""
        return tuple(name for name in self.names if not is_pattern(name))

    def takes(self, topic: str, type_name: str) -> bool:
        """Return whether a topic is selected."""
        if _fits(self.excluded, topic) or _found(self.exclude_regex, topic):
            return False
        if _fits(self.names, topic):
            return True
        if not self.hidden and is_hidden(topic):
            return False
        return self.all or type_name in self.types or _found(self.regex, topic)


def _fits(names: tuple[str, ...], topic: str) -> bool:
    return any(matches(name, topic) if is_pattern(name) else name == topic for name in names)


def _found(regex: re.Pattern[str] | None, topic: str) -> bool:
    return regex is not None and regex.search(topic) is not None
