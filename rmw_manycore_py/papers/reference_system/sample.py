# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""Records in a message: which nodes it has passed, when, and what they missed."""

from __future__ import annotations

import time
from typing import Any

import numpy as np

NAME_BYTES = 48


def now_ns() -> int:
    """Return the system clock, shared by all processes."""
    return time.time_ns()


def name_of(record: Any) -> str:
    """Return the name of the node that wrote a record."""
    return bytes(record.node_name).partition(b"\0")[0].decode()


def records_of(message: Any) -> list[Any]:
    """Return the used records, in the order written."""
    used: list[Any] = message.stats[: message.size]
    return used


def add_record(message: Any, name: str, timestamp_ns: int, sequence: int, dropped: int) -> None:
    """Append a node's record; a full message is unchanged."""
    if message.size == len(message.stats):
        return
    record = type(message.stats[0])(
        timestamp=timestamp_ns, sequence_number=sequence, dropped_samples=dropped
    )
    text = np.frombuffer(name.encode()[: NAME_BYTES - 1], np.uint8)
    record.node_name[: len(text)] = text
    message.stats[message.size] = record
    message.size += 1


def merge_records(message: Any, source: Any) -> None:
    """Append the records of nodes that the message does not contain."""
    known = {bytes(record.node_name) for record in records_of(message)}
    for record in records_of(source):
        if bytes(record.node_name) not in known and message.size < len(message.stats):
            message.stats[message.size] = record
            message.size += 1


class Gaps:
    """Counts gaps in a sequence, from its first number."""

    def __init__(self) -> None:
        self._last: int | None = None

    def before(self, sequence: int) -> int:
        """Return the size of the gap before a number."""
        missing = 0 if self._last is None else max(sequence - self._last - 1, 0)
        self._last = sequence
        return missing


def sequence_of(message: Any) -> int:
    """Return the sender's sequence number: that of the last record."""
    number: int = message.stats[message.size - 1].sequence_number if message.size else 0
    return number
