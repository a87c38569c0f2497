# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""Role of one process for one topic: owner, heir or neither (docs/design/bridge.md)."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Literal

from rmw_manycore_bridge.lanes import LaneTable, Share

RoleName = Literal["owner", "heir", "none"]

# Once no more endpoints match with the heir's: by then silent publishers outside have matched, too.
SETTLE_S = 1.0
STEP_S = 0.02  # polling period of a move in progress


@dataclass(frozen=True)
class Held:
    """Message kept by the heir until it owns the topic."""

    publisher: bytes
    number: int
    data: bytes
    source_timestamp_ns: int


class TopicRole:
    """Role of one process for one topic; used only by the topic's thread."""

    def __init__(self, table: LaneTable | None = None, index: int = 0, lane: int = 0) -> None:
        self._table, self._index, self._lane = table, index, lane
        self.name: RoleName = "owner" if table is None else "none"
        self._passed: dict[bytes, int] = {}
        self._passed_before: dict[bytes, int] | None = None  # numbers when the heir appeared
        self._skipped: dict[bytes, int] = {}  # forwarded by the previous owner
        self._first: dict[bytes, int] = {}
        self._held: list[Held] | None = None  # None before the heir starts to hold

    def update(self) -> Share:
        """Return the current share, and take the role it assigns to this process."""
        if self._table is None:
            return Share(self._lane)
        share = self._table.shares[self._index]
        if share.owner == self._lane:
            role: RoleName = "owner"
        else:
            role = "heir" if share.heir == self._lane else "none"
        if role == "none" or (role == "heir" and self.name != "heir"):
            self._first, self._held = {}, None
        if share.heir is None:
            self._passed_before = None
        self.name = role
        return share

    # As owner.

    def passed(self, publisher: bytes, number: int) -> None:
        """Record a message that is forwarded, or would be without limits."""
        self._passed[publisher] = number

    def repeats(self, publisher: bytes, number: int) -> bool:
        """Return whether the previous owner has forwarded a message."""
        return number <= self._skipped.get(publisher, -1)

    def may_hand_over(self, share: Share) -> bool:
        """Return whether the heir has every message after those forwarded here."""
        if self._passed_before is None:
            self._passed_before = dict(self._passed)
        if share.first is None:
            return False
        return all(
            share.first[publisher.hex()] <= number + 1
            if publisher.hex() in share.first
            else number == self._passed_before.get(publisher)
            for publisher, number in self._passed.items()
        )

    def hand_over(self) -> bool:
        """Make the heir the owner; return False if the heir is gone."""
        assert self._table is not None
        with self._table.change(self._index) as share:
            if share.heir is None:
                return False
            share.owner, share.heir, share.first = share.heir, None, None
            share.last = {gid.hex(): number for gid, number in self._passed.items()}
        return True

    def decline(self) -> None:
        """Abort a move."""
        assert self._table is not None
        with self._table.change(self._index) as share:
            share.heir = share.first = None

    # As heir.

    def hold(self, message: Held) -> None:
        """Keep a message; before settling, only record that its publisher is received."""
        if self._held is None:
            self._first[message.publisher] = message.number + 1
        else:
            self._first.setdefault(message.publisher, message.number)
            self._held.append(message)

    @property
    def holds(self) -> bool:
        """Whether messages are being kept."""
        return self._held is not None

    def begin_to_hold(self) -> None:
        """Start keeping messages."""
        self._held = []

    def report(self, share: Share, matched: int) -> None:
        """Report progress to the owner, and the number of endpoints matched outside."""
        first = {gid.hex(): number for gid, number in self._first.items()}
        if self._table is not None and (share.first, share.matched) != (first, matched):
            with self._table.change(self._index) as present:
                if present.heir == self._lane:
                    present.first, present.matched = first, matched

    def inherit(self, share: Share) -> list[Held]:
        """As the new owner, return the held messages that the previous owner did not forward."""
        if self._held is None:
            return []
        self._skipped = {bytes.fromhex(gid): number for gid, number in share.last.items()}
        self._passed = dict(self._skipped)
        held, self._held = self._held, None
        return [m for m in held if not self.repeats(m.publisher, m.number)]

    @property
    def inherited(self) -> dict[bytes, int]:
        """Last sequence numbers of the previous owner."""
        return self._skipped
