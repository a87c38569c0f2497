# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""Checks of arguments: each error names the argument, the expected and the found value."""

from __future__ import annotations

import math
import re
import sys
from pathlib import Path

from rmw_manycore_py.native._transport import now_ns
from rmw_manycore_py.ros.names import MAX_NODE_NAME, MAX_TOPIC_NAME, NAME_PART
from rmw_manycore_py.transport.errors import refusal

_TOPIC = re.compile(f"(/{NAME_PART})+")
_NAME = re.compile(NAME_PART)
_NS_PER_S = 1_000_000_000


def checked_topic(topic: str) -> str:
    """Return the full name of a topic."""
    if not isinstance(topic, str) or not _TOPIC.fullmatch(topic):
        raise refusal("topic", "a full name such as /points or /front/points", repr(topic))
    if len(topic) > MAX_TOPIC_NAME:
        raise refusal("topic", f"at most {MAX_TOPIC_NAME} characters", f"{len(topic)}: {topic}")
    return topic


def checked_name(name: str | None) -> str:
    """Return the name of a node, by default one made of the program's."""
    if name is None:
        stem = Path(sys.argv[0] if sys.argv else "").stem
        return re.sub(r"\W", "_", stem, flags=re.ASCII).lstrip("_0123456789") or "python"
    if not isinstance(name, str) or not _NAME.fullmatch(name):
        raise refusal("name", "letters, digits and '_', the first no digit", repr(name))
    if len(name) > MAX_NODE_NAME:
        raise refusal("name", f"at most {MAX_NODE_NAME} characters", f"{len(name)}: {name}")
    return name


def checked_number(what: str, value: int, lowest: int, highest: int) -> int:
    """Return a whole number that lies in a range."""
    if isinstance(value, bool) or not isinstance(value, int) or not lowest <= value <= highest:
        raise refusal(what, f"a whole number from {lowest} to {highest}", repr(value))
    return value


class Deadline:
    """The end of a timeout in seconds; None never comes."""

    def __init__(self, timeout_s: float | None) -> None:
        if timeout_s is not None:
            is_number = isinstance(timeout_s, (int, float)) and not isinstance(timeout_s, bool)
            if not is_number or not 0 <= timeout_s < math.inf:
                raise refusal("timeout_s", "seconds from 0 on, or None", repr(timeout_s))
        self._end_ns = None if timeout_s is None else now_ns() + round(timeout_s * _NS_PER_S)

    def left_s(self) -> float | None:
        """Return the time until then; None if it never comes."""
        return None if self._end_ns is None else max(self._end_ns - now_ns(), 0) / _NS_PER_S
