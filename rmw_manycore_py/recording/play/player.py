# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""Publishes recorded messages with their original timing."""

from __future__ import annotations

import sys
import threading
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from dataclasses import dataclass, field

from rmw_manycore_py.errors import ManycoreError
from rmw_manycore_py.recording.metadata import TopicRow
from rmw_manycore_py.recording.play.clock import Clock
from rmw_manycore_py.recording.play.position import Position
from rmw_manycore_py.recording.play.program import Program, offer_of
from rmw_manycore_py.recording.play.read_ahead import ReadAhead
from rmw_manycore_py.recording.play.stage import RawPublisher, Stage
from rmw_manycore_py.recording.recording import Recording

# Python's thread switch interval; the default of 5 ms would delay messages.
_SWITCH_S = 0.0005
_NS_PER_S = 1_000_000_000


@dataclass
class Tally:
    """Number of played messages, and their lateness (ns), bounded to the newest ones."""

    messages: int = 0
    late_ns: list[int] = field(default_factory=list)

    def add(self, late_ns: int) -> None:
        """Add a message."""
        if len(self.late_ns) < _KEPT:
            self.late_ns.append(late_ns)
        else:
            self.late_ns[self.messages % _KEPT] = late_ns
        self.messages += 1


_KEPT = 1_000_000


class Player:
    """Plays in a thread of its own, unless `play` is called."""

    def __init__(
        self,
        recording: Recording,
        stage: Stage,
        program: Program,
        position: Position,
        *,
        loops: bool = False,
        delay_s: float = 0.0,
        clock_hz: float | None = None,
    ) -> None:
        """Create the publishers.

        :raises ManycoreError: if a topic cannot be played.
        """
        self._recording, self._position = recording, position
        self._loops, self._delay_s = loops, delay_s
        self.start_ns, self.end_ns = program.span_ns(recording)
        rows = program.topics_of(recording, has_clock=clock_hz is not None)
        self._publishers = {
            row.name: _publisher(stage, row, program.new_name(row.name)) for row in rows
        }
        self._go_to_start()
        self._clock = None if clock_hz is None else Clock(stage, position, clock_hz)
        self.tally = Tally()
        self.failure: BaseException | None = None
        self._thread = threading.Thread(target=self._run, name="playing")
        self._ended: Callable[[], None] = lambda: None

    def play(self) -> None:
        """Play in this thread."""
        self._play_all()

    def start(self, ended: Callable[[], None]) -> None:
        """Start playing; `ended` is called at the end."""
        self._ended = ended
        self._thread.start()

    def stop(self) -> None:
        """Stop, unless already ended."""
        self._position.stop()
        if self._thread.ident is not None:
            self._thread.join()

    def _run(self) -> None:
        try:
            with _quick_switches():
                self._play_all()
        except BaseException as error:
            self.failure = error
        finally:
            self._ended()

    def _play_all(self) -> None:
        if self._clock is not None:
            self._clock.start()
        try:
            while self._play_once() and self._loops:
                pass
        finally:
            if self._clock is not None:
                self._clock.stop()

    def _go_to_start(self) -> None:
        lead_ns = self._delay_s * self._position.rate * _NS_PER_S
        self._position.jump(self.start_ns - round(lead_ns))

    def _play_once(self) -> bool:
        """Play from start to end; return whether it was completed."""
        self._go_to_start()
        ahead = ReadAhead(
            self._recording.messages(self._publishers, self.start_ns, self.end_ns + 1)
        )
        try:
            for message in ahead:
                late_ns = self._position.wait_until(message.recorded_ns)
                if late_ns is None:
                    return False
                self._publishers[message.topic].publish(message.data)
                self.tally.add(late_ns)
        finally:
            ahead.close()
        return not self._position.is_over


def _publisher(stage: Stage, row: TopicRow, name: str) -> RawPublisher:
    """Return the publisher of a topic.

    :raises ManycoreError: if others use another type there, or the type is missing.
    """
    for type_name, type_hash in stage.types_of(name).items():
        if type_name != row.type:
            raise ManycoreError(
                f"{name} has type {type_name} here, but {row.type} in the recording: play it under "
                f"another name (--remap {row.name}:=/NAME) or skip it (--exclude-topics {row.name})"
            )
        if row.type_hash and type_hash not in ("", row.type_hash):
            raise ManycoreError(
                f"{name}: {type_name} has another definition here than in the recording "
                f"({type_hash}, not {row.type_hash}): skip it (--exclude-topics {row.name})"
            )
    try:
        return stage.publisher(name, row.type, row.type_hash, offer_of(row.offers))
    except ImportError as error:
        raise ManycoreError(
            f"{row.name} cannot be played: {error}; `manycore interface build PATH`, "
            f"or --exclude-topics {row.name}"
        ) from error


@contextmanager
def _quick_switches() -> Iterator[None]:
    before_s = sys.getswitchinterval()
    sys.setswitchinterval(_SWITCH_S)
    try:
        yield
    finally:
        sys.setswitchinterval(before_s)
