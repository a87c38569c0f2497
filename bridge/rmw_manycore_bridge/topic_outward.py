# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""Outward topic: subscription on the platform -> publisher outside."""

from __future__ import annotations

import time
from collections.abc import Sequence

from rmw_manycore_bridge.outside import types
from rmw_manycore_bridge.outside.interface import Publisher
from rmw_manycore_bridge.policies import common_offer, request_for, satisfies, unmet
from rmw_manycore_bridge.sides import Sides
from rmw_manycore_bridge.topic import BATCH, TURN_S, Topic
from rmw_manycore_bridge.topic_role import STEP_S, TopicRole
from rmw_manycore_py.native import _transport
from rmw_manycore_py.native._transport import EndpointInfo, Qos

_PLATFORM_BYTES = 8  # of a gid, which are the same for all endpoints of a platform


class OutwardTopic(Topic):
    """Runs in the thread of the platform side."""

    def __init__(self, sides: Sides, role: TopicRole) -> None:
        super().__init__(sides, role)
        self._publisher: Publisher | None = None
        self._subscription: _transport.Subscription | None = None
        self._lost = 0
        self._shown: set[bytes] = set()  # gids of publishers that were there when looked for

    def match(self) -> None:
        """Publish outside while publishers exist; subscribe inside while others do outside."""
        route, inside = self._sides.route, self._sides.inside
        publishers = inside.publishers(route.inside)
        fitting = self._fitting(publishers)
        if not fitting:
            self._leave()
            if publishers:
                self._sides.fail(f"is {publishers[0].type} inside, not {route.type}")
            else:
                self._sides.row.set_state("waiting")
            return
        offers = [p.qos for p in fitting]
        if reason := unmet(offers, route.qos):
            self._leave()
            self._sides.fail(reason)
            return
        offer = common_offer(offers, route.qos)
        if self._offer is None or not satisfies(self._offer, offer):
            self._renew(offer)
            # Those whose messages were just forwarded may have appeared meanwhile.
            fitting = self._fitting(inside.publishers(route.inside))
        self._show(fitting)
        if self._is_wanted(offer):
            self._listen()
        else:
            self.stop_listening()
            self._sides.row.rest()
        self._sides.row.set_state("ready" if self._subscription is None else "forwarding")

    def _fitting(self, publishers: Sequence[EndpointInfo]) -> list[EndpointInfo]:
        return [p for p in publishers if p.type == self._sides.route.type]

    def _show(self, publishers: Sequence[EndpointInfo]) -> None:
        assert self._publisher is not None
        self._publisher.show(publishers)
        self._shown = {one.gid for one in publishers}

    def _is_wanted(self, offer: Qos) -> bool:
        kept = offer.durability == "transient_local"
        assert self._publisher is not None
        return kept or self._sides.route.eager or self._publisher.has_listeners()

    def _leave(self) -> None:
        """Forward unread messages and wait for slow subscribers, which would lose them otherwise.

        The engine itself gives up on subscribers that have ended or are stopped.
        """
        self.take(self._depth)
        self.stop_listening()
        if self._publisher is None or self.is_acknowledged():
            self.close()
        else:
            self.due_s = time.monotonic() + STEP_S

    def _renew(self, offer: Qos) -> None:
        """Publish with another QoS; what is shown outside stays.

        The next subscription begins before this one ends; what both receive is forwarded once.
        """
        following = None if self._subscription is None else self._subscribe(offer)
        self.take(self._depth)
        self.stop_listening()
        if self._publisher is not None:
            self._publisher.close()
        self._publisher = self._sides.outside.publish(self._sides.route, offer)
        self._sides.row.add_gid(self._publisher.gid)
        self._offer = offer
        if following is not None:
            self._begin(following, offer)

    def _listen(self) -> None:
        if self._subscription is not None or self._offer is None or self._publisher is None:
            return
        self._begin(self._subscribe(self._offer), self._offer)

    def _subscribe(self, offer: Qos) -> _transport.Subscription:
        route = self._sides.route
        return self._sides.inside.process.subscription(
            *(route.inside, route.type, request_for(offer, 1)),
            type_hash=types.hash_of(route.type),
        )

    def _begin(self, subscription: _transport.Subscription, offer: Qos) -> None:
        assert self._publisher is not None
        self._publisher.resume()  # what was on its way to a subscription before is lost
        self._subscription = subscription
        self._depth, self._lost = request_for(offer, 1).depth, 0
        self._sides.inside.readers.append(self)

    def stop_listening(self) -> None:
        """Destroy the subscription."""
        self.pause()
        self._subscription = None

    def pump_inside(self) -> None:
        """Forward messages that have arrived."""
        if self._subscription is None or not self._subscription.has_data():
            return
        began_ns = time.thread_time_ns()
        self.take(BATCH, TURN_S)
        self._sides.row.worked(time.thread_time_ns() - began_ns)

    def take(self, limit: int, limit_s: float = float("inf")) -> None:
        """Take up to `limit` messages, and none after `limit_s`."""
        subscription, end_s = self._subscription, time.monotonic() + limit_s
        if subscription is None:
            return
        while limit > 0 and time.monotonic() < end_s:
            claim = subscription.claim()
            if claim is None:
                break
            limit -= 1
            try:
                self.arrived(
                    *(claim.publisher, claim.sequence),
                    *(claim.address, claim.size, claim.source_timestamp_ns),
                )
            finally:
                claim.release()
        else:
            self._sides.inside.wake()  # continue after the other routes
        self._count_lost(subscription)

    def is_own(self, publisher: bytes) -> bool:
        """Return whether this bridge published it; a link publishes all from other platforms."""
        if self._sides.outside.links_platforms and self._subscription is not None:
            return publisher[:_PLATFORM_BYTES] != self._subscription.gid[:_PLATFORM_BYTES]
        return super().is_own(publisher)

    def send(self, address: int, size: int, sent_ns: int, publisher: bytes, number: int) -> None:
        """Publish outside, where its publisher is shown first."""
        assert self._publisher is not None
        if publisher not in self._shown:
            present = self._fitting(self._sides.inside.publishers(self._sides.route.inside))
            if any(one.gid == publisher for one in present):
                self._show(present)
            self._shown.add(publisher)  # or it has ended
        self._publisher.publish(address, size, sent_ns, publisher, number)
        if self._subscription is not None:
            self._subscription.note_bridged()

    def _count_lost(self, subscription: _transport.Subscription) -> None:
        lost = subscription.lost()
        if lost != self._lost:
            self._sides.row.add("lost", lost - self._lost)
            self._lost = lost

    def pause(self) -> None:
        """Stop taking messages."""
        if self in self._sides.inside.readers:
            self._sides.inside.readers.remove(self)

    def resume(self) -> None:
        """Resume after a pause."""
        if self._subscription is not None:
            self._sides.inside.readers.append(self)

    def matched_outside(self) -> int:
        """Return the number of subscriptions outside that the publisher is matched with."""
        return 0 if self._publisher is None else self._publisher.matched()

    def is_acknowledged(self) -> bool:
        """Return whether every reliable subscriber has acknowledged everything."""
        return self._publisher is None or self._publisher.is_acknowledged()

    def close(self) -> None:
        """Leave both sides."""
        self.stop_listening()
        if self._publisher is not None:
            self._show(())
            self._publisher.close()
        self._publisher = self._offer = None
