# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""Inward topic: subscription outside -> publisher on the platform."""

from __future__ import annotations

import time
from collections.abc import Mapping

from rmw_manycore_bridge.limits import Gaps
from rmw_manycore_bridge.outside import types
from rmw_manycore_bridge.outside.interface import Subscription
from rmw_manycore_bridge.place import Place
from rmw_manycore_bridge.policies import common_offer, request_for, satisfies, unmet
from rmw_manycore_bridge.sides import Sides
from rmw_manycore_bridge.topic import BATCH, Topic
from rmw_manycore_py.native import _transport
from rmw_manycore_py.native._transport import Qos


class InwardTopic(Topic):
    """Runs in the thread of the outside."""

    def __init__(self, sides: Sides, place: Place) -> None:
        super().__init__(sides, place)
        self._publisher: _transport.Publisher | None = None
        self._subscription: Subscription | None = None
        self._gaps = Gaps(sides.row)

    def match(self) -> None:
        """Publish inside while publishers exist outside; subscribe there while others do inside."""
        route = self._sides.route
        listeners = self._sides.inside.subscriptions(route.inside)
        publishers = self._sides.outside.publishers(route, bool(listeners) or route.eager)
        fitting = [p for p in publishers if p.type == route.type]
        if not fitting:
            self.finish()
            if publishers:
                self._sides.fail(f"is {publishers[0].type} outside, not {route.type}")
            else:
                self._sides.row.set_state("waiting")
            return
        offers = [p.qos for p in fitting]
        if reason := unmet(offers, route.qos):
            self.finish()
            self._sides.fail(reason)
            return
        offer = common_offer(offers, route.qos)
        if self._offer is None or not satisfies(self._offer, offer):
            self.finish()
            if not self._appear(offer):
                return
        if listeners or route.eager or offer.durability == "transient_local":
            self._listen(max((e.qos.depth for e in listeners), default=1))
        else:
            self.stop_listening()
            self._gaps = Gaps(self._sides.row)  # untaken messages are not lost
        self._sides.row.set_state("ready" if self._subscription is None else "forwarding")

    def _appear(self, offer: Qos) -> bool:
        route = self._sides.route
        try:
            self._publisher = self._sides.inside.process.publisher(
                route.inside, route.type, offer, type_hash=types.hash_of(route.type)
            )
        except _transport.PlatformError as error:
            self._sides.fail(str(error))
            return False
        self._sides.row.add_gid(self._publisher.gid)
        self._offer = offer
        return True

    def _listen(self, depth: int) -> None:
        if self._subscription is not None:
            return
        assert self._offer is not None
        request = request_for(self._offer, depth)
        self._subscription = self._sides.outside.subscribe(self._sides.route, request)
        self._depth = request.depth
        self.resume()

    def stop_listening(self) -> None:
        """Destroy the subscription."""
        if self._subscription is None:
            return
        self.pause()
        self._subscription.close()
        self._subscription = None

    def pump_outside(self) -> None:
        """Forward messages that have arrived."""
        began_ns = time.thread_time_ns()
        self.take(BATCH)
        self._sides.row.worked(time.thread_time_ns() - began_ns)

    def take(self, limit: int) -> None:
        """Take up to `limit` messages."""
        taken = self._subscription
        for _ in range(limit):
            if taken is None or not taken.take():
                return
            self.arrived(taken.publisher, taken.number, taken.address, taken.size, taken.sent_ns)

    def send(self, address: int, size: int, sent_ns: int) -> None:
        """Publish inside with the source timestamp of the publisher outside."""
        assert self._publisher is not None
        self._publisher.publish_from(address, size, sent_ns)

    def begin_after(self, last: Mapping[bytes, int]) -> None:
        """Count gaps from the sequence numbers of the previous lane."""
        self._gaps.begin_after(last)

    def count_gap(self, publisher: bytes, number: int) -> None:
        """Count messages that did not arrive."""
        self._gaps.note(publisher, number)

    def pause(self) -> None:
        """Stop taking messages."""
        self._sides.outside.readers.pop(self._subscription, None)

    def resume(self) -> None:
        """Resume after a pause."""
        if self._subscription is not None:
            self._sides.outside.readers[self._subscription] = self.pump_outside

    def matched_outside(self) -> int:
        """Return the number of publishers outside that the subscription is matched with."""
        return 0 if self._subscription is None else self._subscription.matched()

    def is_acknowledged(self) -> bool:
        """Return True: on the platform, readers have a message as soon as it is published."""
        return True

    def close(self) -> None:
        """Leave both sides."""
        self.stop_listening()
        self._publisher = self._offer = None
