# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""What a traced thread does between two waits: its callbacks, and their publications.

The tracer sees an rmw, not callbacks. So a callback lasts from its take to the thread's next take
or wait, and what a thread does between a wait and its first take is a timer's callback if it
publishes, or if the wait ended by its timeout.
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from dataclasses import dataclass, field

from rmw_manycore_py.trace.events import EndpointId, Kind, Row, endpoint_id

_FOREVER_NS = 1 << 62  # timeouts beyond are none


@dataclass(frozen=True)
class Publication:
    """A message that was published."""

    endpoint: EndpointId
    at_ns: int
    size_bytes: int
    publish_ns: int = 0  # until readers see it


@dataclass
class Turn:
    """A callback's execution; or, without a trigger, what may be a timer's."""

    trigger: EndpointId | None
    begin_ns: int
    timed_out: bool = False
    due_ns: int | None = None  # end of the timeout that rcl gave to the wait, if that has passed
    dispatch_ns: int | None = None  # since the thread was free
    end_ns: int | None = None
    cpu_ns: float | None = None  # None if unknown
    publications: list[Publication] = field(default_factory=list)

    @property
    def is_callback(self) -> bool:
        """Whether it is more than the executor's own work."""
        return self.trigger is not None or self.timed_out or bool(self.publications)

    @property
    def wall_ns(self) -> int:
        """From begin to end; 0 without an end."""
        return 0 if self.end_ns is None else self.end_ns - self.begin_ns


@dataclass
class Outside:
    """Publications of a thread that was in no callback."""

    publications: list[Publication] = field(default_factory=list)


class _CpuTime:
    """Spreads CPU time between two readings over the turns there, by their wall time.

    The tracer reads the clock at begins and ends of waits, but not at all of them.
    """

    def __init__(self) -> None:
        self._turns: list[Turn] = []
        self._last_ns = 0  # 0: not read yet
        self._active_ns = 0  # wall time since then, without waits

    def add(self, turn: Turn) -> None:
        self._turns.append(turn)

    def pass_time(self, active_ns: int) -> None:
        self._active_ns += active_ns

    def read(self, cpu_ns: int) -> list[Turn]:
        """Take a reading, 0 for none; return the turns that are complete."""
        if not cpu_ns:
            return []
        turns = self._turns
        if self._last_ns and self._active_ns:
            share = min((cpu_ns - self._last_ns) / self._active_ns, 1.0)
            for turn in turns:
                turn.cpu_ns = turn.wall_ns * share
        self._turns, self._last_ns, self._active_ns = [], cpu_ns, 0
        return turns

    def rest(self) -> list[Turn]:
        return self._turns


def turns_of(rows: Iterable[Row], outside: Outside) -> Iterator[Turn]:
    """Yield the turns of a thread; the last one may have no end."""
    cpu = _CpuTime()
    woken_ns: int | None = None
    turn: Turn | None = None
    publish_ns: int | None = None
    free_ns: int | None = None
    due_ns: int | None = None
    for time_ns, number, value, slot, incarnation, kind in rows:
        if kind == Kind.PUBLISH_BEGIN:
            publish_ns = time_ns
        elif kind == Kind.WRITE:
            at_ns = time_ns if publish_ns is None else publish_ns
            publication = Publication(endpoint_id(slot, incarnation), at_ns, value, time_ns - at_ns)
            (outside if turn is None else turn).publications.append(publication)
            publish_ns = None
        elif kind in (Kind.CLAIM, Kind.WAIT_BEGIN):
            if turn is not None:
                turn.end_ns = time_ns
                cpu.add(turn)
                free_ns = turn.begin_ns if _is_idle(turn) else time_ns
                turn = None
            if kind == Kind.WAIT_BEGIN:
                cpu.pass_time(0 if woken_ns is None else time_ns - woken_ns)
                woken_ns = None
                due_ns = time_ns + value if 0 < value < _FOREVER_NS else None
                yield from cpu.read(number)
        elif kind == Kind.RELEASE:
            turn = Turn(endpoint_id(slot, incarnation), time_ns)
            turn.dispatch_ns = None if free_ns is None else time_ns - free_ns
            free_ns = None
        elif kind == Kind.WAIT_END:
            yield from cpu.read(number)
            woken_ns = time_ns
            turn = Turn(None, time_ns, timed_out=value == 0)
            turn.due_ns = due_ns if due_ns is not None and due_ns <= time_ns else None
    yield from cpu.rest()
    if turn is not None:
        yield turn


def _is_idle(turn: Turn) -> bool:
    """Return whether a thread only woke up before it took a message."""
    return not turn.is_callback
