# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""Looks up topics in a bag."""

from __future__ import annotations

from pathlib import Path
from typing import Any

from rmw_manycore_py.errors import EXIT_BAD_INPUT, ManycoreError


def connections_of(
    path: Path, reader: Any, kinds: set[str], topic: str, option: str
) -> tuple[Any, ...]:
    """Return the connections of a topic, one per publisher.

    Without `topic`, uses the only topic of these types; if there are several, the error names
    `option`.
    """
    fitting = [one for one in reader.connections if one.msgtype in kinds]
    chosen = [one for one in fitting if not topic or one.topic == topic]
    if len({(one.topic, one.msgtype) for one in chosen}) == 1:
        return tuple(chosen)
    names = ", ".join(f"{one.topic} ({one.msgtype})" for one in fitting) or "none"
    expected = f"the topic {topic}" if topic else "one topic"
    raise ManycoreError(
        f"{path}: expected {expected} of the type {' or '.join(sorted(kinds))}, found {names}: "
        f"name one with {option}",
        EXIT_BAD_INPUT,
    )
