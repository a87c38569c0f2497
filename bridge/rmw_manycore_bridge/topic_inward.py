# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""Inward topic: subscription outside -> publisher on the platform."""

from __future__ import annotations

import time
from collections.abc import Mapping, Sequence

from rmw_manycore_bridge.limits import Gaps
from rmw_manycore_bridge.outside import types
from rmw_manycore_bridge.outside.interface import Endpoint, Subscription
from rmw_manycore_bridge.policies import common_offer, request_for, satisfies, unmet
from rmw_manycore_bridge.sides import Sides
from rmw_manycore_bridge.topic import BATCH, Topic
from rmw_manycore_bridge.topic_role import TopicRole
from rmw_manycore_py.native import _transport
from rmw_manycore_py.native._transport import Qos

_OWN = b""


class InwardTopic(Topic):
    """Runs in the thread of the outside."""

    def __init__(self, sides: Sides, role: TopicRole) -> None:
        super().__init__(sides, role)
        # By gid outside; other messages are the bridge's own, which has an empty one.
        self._publishers: dict[bytes, _transport.Publisher] = {}
        self._published: dict[bytes, int] = {}  # last number of each that stands for another
        self._unnamed: set[bytes] = set()  # gids that are not shown outside
        self._subscription: Subscription | None = None
        self._gaps = Gaps(sides.row)

    def match(self) -> None:
        """Publish inside while publishers exist outside; subscribe there while others do inside."""
        route = self._sides.route
        listeners = self._sides.inside.subscriptions(route.inside)
        publishers = self._sides.outside.publishers(route, bool(listeners) or route.eager)
        fitting = self._fitting(publishers)
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
        depth = max((e.qos.depth for e in listeners), default=1)
        if self._offer is None or not satisfies(self._offer, offer):
            self._renew(offer, depth)
            # Those whose messages were just forwarded may have appeared meanwhile.
            fitting = self._fitting(self._sides.outside.publishers(route, True))
        if not self._appear(fitting):
            return
        if listeners or route.eager or offer.durability == "transient_local":
            self._listen(depth)
        else:
            self.stop_listening()
            self._gaps = Gaps(self._sides.row)  # untaken messages are not lost
            self._sides.row.rest()
        self._sides.row.set_state("ready" if self._subscription is None else "forwarding")

    def _renew(self, offer: Qos, depth: int) -> None:
        """Go on with another QoS; what stands for others stays.

        The next subscription begins before this one ends; what both receive is forwarded once.
        """
        following = None if self._subscription is None else self._subscribe(offer, depth)
        self.take(self._depth)
        self.stop_listening()
        self._publishers.pop(_OWN, None)
        self._offer = offer
        if following is not None:
            self._begin(following, offer, depth)

    def _fitting(self, publishers: Sequence[Endpoint]) -> list[Endpoint]:
        return [p for p in publishers if p.type == self._sides.route.type]

    def _appear(self, publishers: Sequence[Endpoint]) -> bool:
        """Publish on the platform, on nodes of the same names where publishers have them."""
        named = {one.gid: one for one in publishers if one.node}
        for gid in self._publishers.keys() - named.keys() - {_OWN}:
            del self._publishers[gid]
            self._published.pop(gid, None)
        self._unnamed.clear()
        try:
            for gid in named.keys() - self._publishers.keys():
                self._publishers[gid] = self._stand_in(named[gid])
            if not named:
                self._own_publisher()
        except _transport.PlatformError as error:
            self.close()
            self._sides.fail(str(error))
            return False
        return True

    def _stand_in(self, publisher: Endpoint) -> _transport.Publisher:
        route, inside = self._sides.route, self._sides.inside
        return inside.process.publisher(
            *(route.inside, route.type, publisher.qos),
            type_hash=types.hash_of(route.type),
            node=inside.stand_in(publisher.node),
            gid=publisher.source or None,
        )

    def _own_publisher(self) -> _transport.Publisher:
        found = self._publishers.get(_OWN)
        if found is None:
            assert self._offer is not None
            route, process = self._sides.route, self._sides.inside.process
            type_hash = types.hash_of(route.type)
            found = process.publisher(route.inside, route.type, self._offer, type_hash=type_hash)
            self._publishers[_OWN] = found
            self._sides.row.add_gid(found.gid)  # others have gids of other platforms
        return found

    def _listen(self, depth: int) -> None:
        if self._subscription is not None:
            return
        assert self._offer is not None
        self._begin(self._subscribe(self._offer, depth), self._offer, depth)

    def _subscribe(self, offer: Qos, depth: int) -> Subscription:
        return self._sides.outside.subscribe(self._sides.route, request_for(offer, depth))

    def _begin(self, subscription: Subscription, offer: Qos, depth: int) -> None:
        self._subscription = subscription
        self._depth = request_for(offer, depth).depth
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

    def send(self, address: int, size: int, sent_ns: int, publisher: bytes, number: int) -> None:
        """Publish inside with the source timestamp of the publisher outside."""
        found = self._publishers.get(publisher) or self._late(publisher)
        found.publish_from(address, size, sent_ns)
        if publisher in self._publishers:
            self._published[publisher] = number

    def drops_repeated(self, publisher: bytes, number: int) -> bool:
        """Drop latched messages, too, where the publisher that stands for theirs has them."""
        if super().drops_repeated(publisher, number):
            return True
        last = self._published.get(publisher)
        return last is not None and number <= last

    def _late(self, publisher: bytes) -> _transport.Publisher:
        """Return the publisher here of one that is not known yet, or that has ended."""
        outside, route = self._sides.outside, self._sides.route
        if outside.links_platforms and publisher not in self._unnamed:
            for one in self._fitting(outside.publishers(route, True)):
                if one.gid == publisher:
                    return self._publishers.setdefault(publisher, self._stand_in(one))
            self._unnamed.add(publisher)
        return self._own_publisher()

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
        self._published.clear()
        self._unnamed.clear()
