# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""Inward topic: subscription outside -> publisher on the platform."""

from __future__ import annotations

import time
from collections.abc import Mapping, Sequence
from typing import NamedTuple

from rmw_manycore_bridge.limits import Gaps
from rmw_manycore_bridge.outside import types
from rmw_manycore_bridge.outside.interface import Endpoint, Subscription
from rmw_manycore_bridge.policies import common_offer, request_for, satisfies, unmet
from rmw_manycore_bridge.sides import Sides
from rmw_manycore_bridge.topic import BATCH, Topic
from rmw_manycore_bridge.topic_role import TopicRole
from rmw_manycore_py.native import _transport


class _Publisher(NamedTuple):
    """Publisher on the platform; one that stands for another host's has the name of its node."""

    entity: _transport.Publisher
    node: _transport.Node | None


class InwardTopic(Topic):
    """Runs in the thread of the outside."""

    def __init__(self, sides: Sides, role: TopicRole) -> None:
        super().__init__(sides, role)
        self._publishers: dict[bytes, _Publisher] = {}  # by gid outside
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
            self._offer = offer
        if not self._appear(fitting):
            return
        if listeners or route.eager or offer.durability == "transient_local":
            self._listen(max((e.qos.depth for e in listeners), default=1))
        else:
            self.stop_listening()
            self._gaps = Gaps(self._sides.row)  # untaken messages are not lost
        self._sides.row.set_state("ready" if self._subscription is None else "forwarding")

    def _appear(self, publishers: Sequence[Endpoint]) -> bool:
        """Publish on the platform, on nodes of the same names where publishers have them."""
        assert self._offer is not None
        named = {one.gid: one for one in publishers if one.node}
        wanted = named or {b"": Endpoint(self._sides.route.type, self._offer)}
        for gid in self._publishers.keys() - wanted.keys():
            del self._publishers[gid]
        try:
            for gid in wanted.keys() - self._publishers.keys():
                self._publishers[gid] = self._made(wanted[gid])
        except _transport.PlatformError as error:
            self.close()
            self._sides.fail(str(error))
            return False
        return True

    def _made(self, publisher: Endpoint) -> _Publisher:
        route, inside = self._sides.route, self._sides.inside
        node = inside.stand_in(publisher.node) if publisher.node else None
        type_hash = types.hash_of(route.type)
        entity = inside.process.publisher(
            *(route.inside, route.type, publisher.qos),
            type_hash=type_hash,
            node=node,
            gid=publisher.source or None,
        )
        if node is None:  # others have gids of other platforms
            self._sides.row.add_gid(entity.gid)
        return _Publisher(entity, node)

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

    def send(self, address: int, size: int, sent_ns: int, publisher: bytes, _: int) -> None:
        """Publish inside with the source timestamp of the publisher outside."""
        found = self._publishers.get(publisher) or next(iter(self._publishers.values()))
        found.entity.publish_from(address, size, sent_ns)

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
        self._offer = None
        self._publishers.clear()
