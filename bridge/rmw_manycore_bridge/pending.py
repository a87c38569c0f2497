# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""Requests that wait for their replies, and the answer that is given when none comes."""

from __future__ import annotations

import threading
import time
from collections.abc import Callable
from dataclasses import dataclass
from typing import Any

# Fields in which responses of ROS say what went wrong.
_REASON_FIELDS = ("message", "status_message", "reason", "error_string", "error_message")
_REJECTED = 1  # action_msgs/srv/CancelGoal: ERROR_REJECTED


def empty_answer(response_type: Any, reason: str) -> Any:
    """Return a response as ROS makes it, all zero and false, with the reason where it has room.

    ROS 2 has no error replies: this is what keeps a caller from waiting for ever.
    """
    response = response_type()
    for name, kind in response_type.get_fields_and_field_types().items():
        if name in _REASON_FIELDS and kind == "string":
            setattr(response, name, reason)
    if hasattr(response, "return_code") and hasattr(response, "goals_canceling"):
        response.return_code = _REJECTED
    return response


@dataclass(frozen=True)
class Asked:
    """A request on its way: whom to answer, when it came and until when it may wait."""

    caller: Any
    since_ns: int
    due_s: float


class Pending:
    """The requests of one service by the number they were passed on with. Thread-safe."""

    def __init__(self, timeout_s: float | None) -> None:
        self._timeout_s = timeout_s
        self._asked: dict[int, Asked] = {}
        self._lock = threading.Lock()

    def ask(self, caller: Any, send: Callable[[], int]) -> None:
        """Note a request that has been sent, by its number; replies are looked up after that."""
        with self._lock:
            self._asked[send()] = self._now(caller)

    def _now(self, caller: Any) -> Asked:
        due_s = float("inf") if self._timeout_s is None else time.monotonic() + self._timeout_s
        return Asked(caller, time.time_ns(), due_s)

    def answered(self, number: int) -> Asked | None:
        """Return who asked, once; None when nobody waits any more."""
        with self._lock:
            return self._asked.pop(number, None)

    def overdue(self, now_s: float) -> list[Asked]:
        """Return those whose time is over, once."""
        with self._lock:
            late = [number for number, asked in self._asked.items() if asked.due_s <= now_s]
            return [self._asked.pop(number) for number in late]

    def all(self) -> list[Asked]:
        """Return all of them, once."""
        return self.overdue(float("inf"))

    @property
    def due_s(self) -> float:
        """When the next one is overdue, on the monotonic clock."""
        with self._lock:
            return min((asked.due_s for asked in self._asked.values()), default=float("inf"))
