# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""What is played: which topics of a recording, as which, and from when to when."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from dataclasses import dataclass, field

from rmw_manycore_py._transport import Qos
from rmw_manycore_py.errors import EXIT_BAD_INPUT, ManycoreError
from rmw_manycore_py.recording.metadata import TopicRow
from rmw_manycore_py.recording.recording import Recording
from rmw_manycore_py.recording.selection import Selection

CLOCK_TOPIC = "/clock"
_NS_PER_S = 1_000_000_000
# DDS does not tell how much history a publisher keeps; of latched topics more than was kept would
# be older maps, of others it is room for a burst.
_LEAST_DEPTH = 10


@dataclass(frozen=True)
class Program:
    """Topics of a recording and the part of it that is played."""

    selection: Selection
    remappings: dict[str, str] = field(default_factory=dict)
    start_offset_s: float = 0.0
    duration_s: float | None = None

    def topics_of(self, recording: Recording, *, has_clock: bool) -> list[TopicRow]:
        """Return the topics that are played; a recorded /clock is not, where there is another.

        :raises ManycoreError: when one cannot be, or none is left.
        """
        chosen = [row for row in recording.topics if self.selection.takes(row.name, row.type)]
        missing = set(self.selection.plain_names) - {row.name for row in chosen}
        if missing:
            names = ", ".join(row.name for row in recording.topics) or "none"
            raise ManycoreError(
                f"{recording.path}: expected the topic {min(missing)}, found {names}",
                EXIT_BAD_INPUT,
            )
        if has_clock:
            chosen = [row for row in chosen if row.name != CLOCK_TOPIC]
        if not chosen:
            raise ManycoreError(f"{recording.path}: no topic is left to play", EXIT_BAD_INPUT)
        for row in chosen:
            _check(row, chosen)
        return chosen

    def new_name(self, topic: str) -> str:
        """Return the name that a topic is played under."""
        return self.remappings.get(topic, topic)

    def span_ns(self, recording: Recording) -> tuple[int, int]:
        """Return the time of the first message, and the time that none is later than.

        :raises ManycoreError: when it begins behind the end.
        """
        span = recording.span
        start_ns = span.start_ns + round(self.start_offset_s * _NS_PER_S)
        if span.messages and start_ns > span.end_ns:
            raise ManycoreError(
                f"--start-offset {self.start_offset_s:g}: {recording.path} is "
                f"{span.duration_ns / _NS_PER_S:.3f} s long",
                EXIT_BAD_INPUT,
            )
        if self.duration_s is None:
            return start_ns, span.end_ns
        return start_ns, min(span.end_ns, start_ns + round(self.duration_s * _NS_PER_S))


def _check(row: TopicRow, chosen: Iterable[TopicRow]) -> None:
    types = sorted(other.type for other in chosen if other.name == row.name)
    if len(types) > 1:
        raise ManycoreError(
            f"the recording has several types of {row.name}, {' and '.join(types)}: leave it out "
            f"(--exclude-topics {row.name})",
            EXIT_BAD_INPUT,
        )
    if row.encoding != "cdr" or row.type.count("/") != 2:
        raise ManycoreError(
            f"{row.name}: expected messages of ROS 2 in CDR, found '{row.type}' in "
            f"'{row.encoding}': leave it out (--exclude-topics {row.name})",
            EXIT_BAD_INPUT,
        )


def offer_of(offers: Sequence[Qos]) -> Qos:
    """Return what a player offers: all that any of the recorded publishers did.

    So each subscription that heard one of them hears the player. Depths add up, as a late
    subscriber of a latched topic gets what each publisher had kept.
    """
    if not offers:
        return Qos()
    reliable = any(offer.reliability == "reliable" for offer in offers)
    kept = any(offer.durability == "transient_local" for offer in offers)
    depth = sum(offer.depth for offer in offers)
    by_hand = any(offer.liveliness == "manual_by_topic" for offer in offers)
    return Qos(
        reliability="reliable" if reliable else "best_effort",
        durability="transient_local" if kept else "volatile",
        depth=depth if kept else max(depth, _LEAST_DEPTH),
        deadline_ns=_shortest(offer.deadline_ns for offer in offers),
        liveliness="manual_by_topic" if by_hand else "automatic",
        liveliness_lease_ns=_shortest(offer.liveliness_lease_ns for offer in offers),
        lifespan_ns=_shortest(offer.lifespan_ns for offer in offers),
    )


def _shortest(durations_ns: Iterable[int | None]) -> int | None:
    return min((d for d in durations_ns if d is not None), default=None)
