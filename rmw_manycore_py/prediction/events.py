# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""Events of a simulated run, as the tracer records those of a real one."""

from __future__ import annotations

from array import array
from dataclasses import dataclass

import numpy as np

from rmw_manycore_py.trace.events import EVENT, NO_ENDPOINT, Events, Kind

_FIELDS = len(EVENT.names or ())
# Times of CLOCK_MONOTONIC start at the boot: 0 stands for none.
START_NS = 1_000_000_000


@dataclass(eq=False)
class EventLog:
    """Events of one thread in order; records nothing unless it is on."""

    is_on: bool
    rows: array[int]
    last_ns: int = START_NS

    @classmethod
    def new(cls, is_on: bool) -> EventLog:
        """Return a log without events."""
        return cls(is_on, array("q"))

    def add(
        self, now: float, kind: Kind, endpoint: int = NO_ENDPOINT, number: int = 0, value: int = 0
    ) -> None:
        """Record an event."""
        if self.is_on:
            self.last_ns = max(round(now) + START_NS, self.last_ns)
            self.rows.extend((self.last_ns, number, value, endpoint, 0, kind))

    def events(self) -> Events:
        """Return the recorded events."""
        columns = np.frombuffer(self.rows, np.int64).reshape(-1, _FIELDS)
        found = np.empty(len(columns), EVENT)
        for index, name in enumerate(EVENT.names or ()):
            found[name] = columns[:, index]
        return found
