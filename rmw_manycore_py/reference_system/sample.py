# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""The records in a message: which nodes it has passed, when, and what they missed."""

from __future__ import annotations

import time
from typing import Any

import numpy as np

NAME_BYTES = 48


def now_ns() -> int:
    """Return the system clock, which all processes share."""
    return time.time_ns()


def name_of(record: Any) -> str:
    """Return the node that wrote a record."""
    return bytes(record.node_name).partition(b"\0")[0].decode()


def records_of(message: Any) -> list[Any]:
    """Return the records in use, in the order in which they were written."""
    used: list[Any] = message.stats[: message.size]
    return used


def add_record(message: Any, name: str, timestamp_ns: int, sequence: int, dropped: int) -> None:
    """Write a node's own record behind the others; a full message keeps those it has."""
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
    """Take over the records of nodes that the message has none of."""
    known = {bytes(record.node_name) for record in records_of(message)}
    for record in records_of(source):
        if bytes(record.node_name) not in known and message.size < len(message.stats):
            message.stats[message.size] = record
            message.size += 1


class Gaps:
    """Counts the numbers that are missing in a sequence, from the first that comes."""

    def __init__(self) -> None:
        self._last: int | None = None

    def before(self, sequence: int) -> int:
        """Return how many are missing between the number before and this one."""
        missing = 0 if self._last is None else max(sequence - self._last - 1, 0)
        self._last = sequence
        return missing


def sequence_of(message: Any) -> int:
    """Return the number that the sender gave to this message: its record is the last one."""
    number: int = message.stats[message.size - 1].sequence_number if message.size else 0
    return number
