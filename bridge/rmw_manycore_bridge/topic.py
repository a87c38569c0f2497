# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""Common part of both directions of a topic: limits, counters, and moves between lanes."""

from __future__ import annotations

import ctypes
import time
from abc import abstractmethod
from collections.abc import Mapping

from rmw_manycore_bridge.lanes import Share
from rmw_manycore_bridge.limits import Limits
from rmw_manycore_bridge.outside.loop import Mover
from rmw_manycore_bridge.sides import Sides
from rmw_manycore_bridge.topic_role import SETTLE_S, STEP_S, Held, TopicRole
from rmw_manycore_py.native import _transport
from rmw_manycore_py.native._transport import Qos

BATCH, TURN_S = 16, 0.01  # of one route before the next route's turn: a slow link takes long
LINGER_S = 1.0  # the old owner keeps its publisher until subscribers have its messages
PAUSE_S = 0.2  # abort the hand-over if draining takes longer

_NEVER_S = float("inf")


class Topic(Mover):
    """One topic in one process; everything but `role` belongs to the receiving thread."""

    def __init__(self, sides: Sides, role: TopicRole) -> None:
        super().__init__(sides.fail)
        self._sides, self._role = sides, role
        sides.outside.require_type(sides.route.type)
        self._limits = Limits(sides.route)
        self._offer: Qos | None = None
        self._depth = 0  # of the subscription, the maximum number of unread messages
        self._paused = False
        self._paused_s = 0.0
        self._settled_s = _NEVER_S
        # As heir: the offer that its endpoints were created for, and how many have matched.
        self._offer_held: Qos | None = None
        self._matched = 0

    def reconcile(self) -> None:
        """Adapt the endpoints to both graphs, and advance a move by one step."""
        share, before = self._role.update(), self._role.name
        self.due_s = _NEVER_S
        if before == "none":
            self._rest()
            return
        if before == "owner" and self._role.holds:
            self._inherit(share)  # with the endpoints the messages were held for
        if self._paused and before == "owner" and share.heir is None:
            self._paused = False
            self.resume()
        if not self._paused:
            self.match()
            latched = self._offer is not None and self._offer.durability == "transient_local"
            self._sides.row.set_latched(latched)
        if before == "heir":
            self._prepare(share)
            return
        if share.heir is not None:
            self._give(share)

    def _inherit(self, share: Share) -> None:
        held = self._role.inherit(share)
        self.begin_after(self._role.inherited)
        for message in held:
            if self._offer is None:  # all publishers have gone, and so have the endpoints
                self._sides.row.add("lost")
            else:
                self._pass_on_held(message)

    def expire(self, _: float) -> None:
        """Advance a move by one step."""
        self.try_to_reconcile()

    def _rest(self) -> None:
        """Leave at once or, after a move, when all subscribers have the messages."""
        if self._paused:
            self._paused = False
            self.stop_listening()
            self._settled_s = time.monotonic() + LINGER_S
        if self._offer is None:
            return
        if self._settled_s == _NEVER_S or time.monotonic() >= self._settled_s:
            self._settled_s = _NEVER_S
            self.close()
            self._sides.row.set_state("waiting")
        else:
            self.due_s = self._settled_s

    def _prepare(self, share: Share) -> None:
        """As heir: create endpoints, then hold messages and report to the owner."""
        now_s = time.monotonic()
        self.due_s = now_s + STEP_S
        if self._offer is None:
            if self._role.holds:
                self._role.decline()
            return
        matched = self.matched_outside()
        if self._offer.durability == "transient_local":
            self._role.decline()
        elif not self._role.holds and (self._settled_s == _NEVER_S or matched != self._matched):
            self._settled_s, self._offer_held = now_s + SETTLE_S, self._offer
            self._matched = matched
        elif self._offer is not self._offer_held:
            self._role.decline()  # the endpoints were recreated
        elif self._role.holds:
            self._role.report(share, matched)
        elif now_s >= self._settled_s:
            self._settled_s = _NEVER_S
            self._role.begin_to_hold()

    def _give(self, share: Share) -> None:
        """As owner: stop where the heir can continue, and hand over once all messages are acked."""
        self.due_s = time.monotonic() + STEP_S
        if self._offer is None or self._offer.durability == "transient_local":
            self._role.decline()
        elif self._role.may_hand_over(share):
            if not self._paused:
                if share.matched < self.matched_outside():
                    return  # an endpoint outside has not discovered the heir, or is gone
                if not self.is_acknowledged():
                    return  # a slow subscriber would prolong the pause
                self._paused, self._paused_s = True, time.monotonic()
                self.pause()
            if self.is_acknowledged() and self._role.hand_over():
                self.due_s = time.monotonic()
            elif time.monotonic() > self._paused_s + PAUSE_S:
                self._role.decline()

    def arrived(self, publisher: bytes, number: int, address: int, size: int, sent_ns: int) -> None:
        """Handle an arrived message, unless another lane forwards it."""
        role, row = self._role, self._sides.row
        if self._sides.route.mirrored and self.is_own(publisher):
            row.add("own")
        elif role.name == "heir":
            data = ctypes.string_at(address, size)
            role.hold(Held(publisher, number, data, sent_ns))
        elif not role.repeats(publisher, number) and not self.drops_repeated(publisher, number):
            self._note(publisher, number)
            self._pass_on(address, size, sent_ns, publisher, number)

    def is_own(self, publisher: bytes) -> bool:
        """Return whether a message with that gid was published by this bridge."""
        return self._sides.own.has(publisher)

    def drops_repeated(self, publisher: bytes, number: int) -> bool:
        """Count a message forwarded before, e.g. by a killed process; return whether to drop it.

        A new subscription receives latched messages again, and the new publisher needs them for
        late joiners.
        """
        row = self._sides.row
        if number > row.last_passed.get(publisher, -1):
            return False
        row.add("repeated")
        return self._offer is None or self._offer.durability != "transient_local"

    def _pass_on_held(self, held: Held) -> None:
        address = ctypes.cast(ctypes.c_char_p(held.data), ctypes.c_void_p).value or 0
        self._note(held.publisher, held.number)
        source = held.publisher, held.number
        self._pass_on(address, len(held.data), held.source_timestamp_ns, *source)

    def _note(self, publisher: bytes, number: int) -> None:
        self.count_gap(publisher, number)
        self._role.passed(publisher, number)
        self._sides.row.note_last(publisher, number)

    def _pass_on(
        self, address: int, size: int, sent_ns: int, publisher: bytes, number: int
    ) -> None:
        row = self._sides.row
        if refusal := self._limits.refusal(size):
            row.add(refusal)
            return
        try:
            self.send(address, size, sent_ns, publisher, number)
        except (_transport.PlatformError, RuntimeError) as error:
            if row.add("refused") == 1:
                self._sides.report(str(error))
            return
        row.passed(size, time.time_ns() - sent_ns)

    def finish(self) -> None:
        """Forward unread messages, which the subscription would discard, then leave both sides."""
        self.take(self._depth)
        self.close()

    @abstractmethod
    def match(self) -> None:
        """Create or destroy endpoints according to the graphs."""

    @abstractmethod
    def send(self, address: int, size: int, sent_ns: int, publisher: bytes, number: int) -> None:
        """Publish a publisher's message on the other side."""

    @abstractmethod
    def take(self, limit: int) -> None:
        """Take up to `limit` messages."""

    @abstractmethod
    def pause(self) -> None:
        """Stop taking messages."""

    @abstractmethod
    def resume(self) -> None:
        """Resume after a pause."""

    @abstractmethod
    def stop_listening(self) -> None:
        """Destroy the subscription."""

    @abstractmethod
    def matched_outside(self) -> int:
        """Return the number of endpoints that the own one outside is matched with."""

    @abstractmethod
    def is_acknowledged(self) -> bool:
        """Return whether all subscribers on the other side have acknowledged everything."""

    def begin_after(self, last: Mapping[bytes, int]) -> None:
        """Continue after the sequence numbers of the previous lane."""

    def count_gap(self, publisher: bytes, number: int) -> None:
        """Count the messages missing before this one."""
