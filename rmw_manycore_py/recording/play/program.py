# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""Program of a playback: topics, their names, and the time span."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from dataclasses import dataclass, field

from rmw_manycore_py.errors import EXIT_BAD_INPUT, ManycoreError
from rmw_manycore_py.native._transport import Qos
from rmw_manycore_py.recording.metadata import TopicRow
from rmw_manycore_py.recording.recording import Recording
from rmw_manycore_py.recording.selection import Selection

CLOCK_TOPIC = "/clock"
_NS_PER_S = 1_000_000_000
# Minimum depth, since DDS does not announce a publisher's history. A larger depth of latched topics
# would also deliver outdated messages; for others it only absorbs bursts.
_MIN_DEPTH = 10


@dataclass(frozen=True)
class Program:
    """Selection of topics and of a part of a recording."""

    selection: Selection
    remappings: dict[str, str] = field(default_factory=dict)
    start_offset_s: float = 0.0
    duration_s: float | None = None

    def topics_of(self, recording: Recording, *, has_clock: bool) -> list[TopicRow]:
        """Return the topics to play; a recorded /clock is excluded if the player publishes one.

        :raises ManycoreError: if one cannot be played, or none is left.
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
        """Return the name under which a topic is played."""
        return self.remappings.get(topic, topic)

    def span_ns(self, recording: Recording) -> tuple[int, int]:
        """Return the times of the first and of the last possible message.

        :raises ManycoreError: if the start is after the end.
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
    """Return the QoS of a player: at least what any of the recorded publishers offered.

    Each subscription that matched one of them matches the player. Depths add up, since a late
    joiner of a latched topic gets the history of each publisher.
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
        depth=depth if kept else max(depth, _MIN_DEPTH),
        deadline_ns=_shortest(offer.deadline_ns for offer in offers),
        liveliness="manual_by_topic" if by_hand else "automatic",
        liveliness_lease_ns=_shortest(offer.liveliness_lease_ns for offer in offers),
        lifespan_ns=_shortest(offer.lifespan_ns for offer in offers),
    )


def _shortest(durations_ns: Iterable[int | None]) -> int | None:
    return min((d for d in durations_ns if d is not None), default=None)
