# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""What one process is to one topic: its owner, its heir, or nobody (docs/design/bridge.md)."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Literal

from rmw_manycore_bridge.lanes import LaneTable, Share

Role = Literal["owner", "heir", "nobody"]

SETTLE_S = 1.0  # an heir's endpoints have found all others by then, those that are silent too
STEP_S = 0.02  # between looks at a move that is under way


@dataclass(frozen=True)
class Held:
    """A message that the heir keeps until it owns the topic."""

    publisher: bytes
    number: int
    data: bytes
    source_timestamp_ns: int


class Place:
    """One topic in one process; used by the topic's own thread."""

    def __init__(self, table: LaneTable | None = None, index: int = 0, lane: int = 0) -> None:
        self._table, self._index, self._lane = table, index, lane
        self.role: Role = "owner" if table is None else "nobody"
        self._passed: dict[bytes, int] = {}
        self._passed_before: dict[bytes, int] | None = None  # when the heir showed up
        self._skipped: dict[bytes, int] = {}  # what the owner before us passed on
        self._first: dict[bytes, int] = {}
        self._held: list[Held] | None = None  # None before the heir holds

    def look(self) -> Share:
        """Return the present share, and take the role that it gives this process."""
        if self._table is None:
            return Share(self._lane)
        share = self._table.shares[self._index]
        if share.owner == self._lane:
            role: Role = "owner"
        else:
            role = "heir" if share.heir == self._lane else "nobody"
        if role == "nobody" or (role == "heir" and self.role != "heir"):
            self._first, self._held = {}, None
        if share.heir is None:
            self._passed_before = None
        self.role = role
        return share

    # As owner.

    def passed(self, publisher: bytes, number: int) -> None:
        """Note a message that goes to the other side, or would without limits."""
        self._passed[publisher] = number

    def repeats(self, publisher: bytes, number: int) -> bool:
        """Tell whether the owner before us has passed a message on."""
        return number <= self._skipped.get(publisher, -1)

    def may_hand_over(self, share: Share) -> bool:
        """Tell whether the heir has every message that comes after those passed on."""
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
        """Make the heir the owner; False when there is none any more."""
        assert self._table is not None
        with self._table.change(self._index) as share:
            if share.heir is None:
                return False
            share.owner, share.heir, share.first = share.heir, None, None
            share.last = {gid.hex(): number for gid, number in self._passed.items()}
        return True

    def decline(self) -> None:
        """End a move."""
        assert self._table is not None
        with self._table.change(self._index) as share:
            share.heir = share.first = None

    # As heir.

    def hold(self, message: Held) -> None:
        """Keep a message; before all is settled only note that its publisher is heard."""
        if self._held is None:
            self._first[message.publisher] = message.number + 1
        else:
            self._first.setdefault(message.publisher, message.number)
            self._held.append(message)

    @property
    def holds(self) -> bool:
        """Whether messages are kept by now."""
        return self._held is not None

    def begin_to_hold(self) -> None:
        """Keep messages from now on."""
        self._held = []

    def report(self, share: Share) -> None:
        """Tell the owner what is here."""
        first = {gid.hex(): number for gid, number in self._first.items()}
        if self._table is not None and share.first != first:
            with self._table.change(self._index) as present:
                if present.heir == self._lane:
                    present.first = first

    def inherit(self, share: Share) -> list[Held]:
        """Return, now that we are the owner, the messages that the one before did not pass on."""
        if self._held is None:
            return []
        self._skipped = {bytes.fromhex(gid): number for gid, number in share.last.items()}
        self._passed = dict(self._skipped)
        held, self._held = self._held, None
        return [m for m in held if not self.repeats(m.publisher, m.number)]

    @property
    def inherited(self) -> dict[bytes, int]:
        """The last numbers of the owner before us."""
        return self._skipped
