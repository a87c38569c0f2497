# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""A topic on its way out: subscription on the platform -> DDS publisher."""

from __future__ import annotations

import time
from typing import Any

from rclpy.event_handler import PublisherEventCallbacks
from rmw_manycore_py.bridge import types
from rmw_manycore_py.bridge.limits import Limits
from rmw_manycore_py.bridge.loop import Mover
from rmw_manycore_py.bridge.policies import (
    Policies,
    common_offer,
    request_for,
    satisfies,
    to_rclpy,
)
from rmw_manycore_py.bridge.rcl import OutsideError, RawWriter
from rmw_manycore_py.bridge.sides import Sides
from rmw_manycore_py.bridge.topic_inward import BATCH

from rmw_manycore_py import _transport


class OutwardTopic(Mover):
    """Works in the thread of the platform's side."""

    def __init__(self, sides: Sides) -> None:
        super().__init__(sides.fail)
        self._sides = sides
        self._type = types.load(sides.route.type)
        self._limits = Limits(sides.route)
        self._offer: Policies | None = None
        self._publisher: Any = None
        self._writer: RawWriter | None = None
        self._subscription: _transport.Subscription | None = None
        self._lost = 0

    def reconcile(self) -> None:
        """Publish outside while somebody does inside; listen inside while somebody does outside."""
        route, inside = self._sides.route, self._sides.inside
        publishers = inside.publishers(route.inside)
        fitting = [p for p in publishers if p["type"] == route.type]
        if not fitting:
            self.close()
            if publishers:
                self._sides.fail(f"is {publishers[0]['type']} inside, not {route.type}")
            return
        offer = common_offer((p["qos"] for p in fitting), route.qos)
        if self._offer is None or not satisfies(self._offer, offer):
            self.close()
            self._appear(offer)
        if self._is_wanted(offer):
            self._listen()
        else:
            self._stop_listening()
        self._sides.row.set_state("ready" if self._subscription is None else "forwarding")

    def _is_wanted(self, offer: Policies) -> bool:
        route, kept = self._sides.route, offer["durability"] == "transient_local"
        return kept or route.eager or bool(self._sides.outside.subscriptions(route.outside))

    def _appear(self, offer: Policies) -> None:
        self._publisher = self._sides.outside.node.create_publisher(
            self._type,
            self._sides.route.outside,
            to_rclpy(offer),
            event_callbacks=PublisherEventCallbacks(use_default_callbacks=False),
        )
        self._writer = RawWriter(self._publisher)
        self._sides.row.add_gid(self._writer.gid)
        self._offer = offer

    def _listen(self) -> None:
        if self._subscription is not None or self._offer is None:
            return
        route = self._sides.route
        self._subscription = self._sides.inside.process.subscription(
            route.inside,
            route.type,
            request_for(self._offer, 1),
            type_hash=types.hash_of(route.type),
        )
        self._lost = 0
        self._sides.inside.readers.append(self)

    def _stop_listening(self) -> None:
        if self._subscription is None:
            return
        self._sides.inside.readers.remove(self)
        self._subscription = None

    def pump_inside(self) -> None:
        """Pass on what has arrived."""
        subscription = self._subscription
        for _ in range(BATCH):
            claim = subscription.claim() if subscription else None
            if claim is None:
                self._count_lost()
                return
            try:
                self._pass_on(claim)
            finally:
                claim.release()
        self._sides.inside.wake()  # the others have their turn first

    def _pass_on(self, claim: _transport.Claim) -> None:
        row = self._sides.row
        if self._sides.route.mirrored and self._sides.own.has(claim.publisher):
            row.add("own")
            return
        if refusal := self._limits.refusal(claim.size):
            row.add(refusal)
            return
        assert self._writer is not None
        try:
            self._writer.publish(claim.address, claim.size)
        except OutsideError as error:
            if row.add("refused") == 1:
                self._sides.say(str(error))
            return
        row.passed(claim.size, time.time_ns() - claim.source_timestamp_ns)

    def _count_lost(self) -> None:
        assert self._subscription is not None
        lost = self._subscription.lost()
        if lost != self._lost:
            self._sides.row.add("lost", lost - self._lost)
            self._lost = lost

    def close(self) -> None:
        """Leave both sides."""
        self._stop_listening()
        if self._publisher is not None:
            self._sides.outside.node.destroy_publisher(self._publisher)
        self._publisher = self._writer = self._offer = None
        self._sides.row.set_state("waiting")
