# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""Inward topic: DDS subscription -> publisher on the platform."""

from __future__ import annotations

import time
from collections.abc import Mapping
from typing import Any

from rclpy.event_handler import SubscriptionEventCallbacks

from rmw_manycore_bridge import types
from rmw_manycore_bridge.limits import Gaps
from rmw_manycore_bridge.place import Place
from rmw_manycore_bridge.policies import (
    common_offer,
    from_rclpy,
    request_for,
    satisfies,
    to_rclpy,
    unmet,
)
from rmw_manycore_bridge.rcl import RawReader
from rmw_manycore_bridge.sides import Sides
from rmw_manycore_bridge.topic import BATCH, Topic
from rmw_manycore_py.native import _transport
from rmw_manycore_py.native._transport import Qos


class InwardTopic(Topic):
    """Runs in the thread of its DDS domain."""

    kind = "subscription"

    def __init__(self, sides: Sides, place: Place) -> None:
        super().__init__(sides, place)
        self._publisher: _transport.Publisher | None = None
        self.entity: Any = None  # the DDS subscription
        self._reader: RawReader | None = None
        self._gaps = Gaps(sides.row)

    def match(self) -> None:
        """Publish inside while DDS publishers exist; subscribe to DDS while subscriptions exist."""
        route, outside = self._sides.route, self._sides.outside
        publishers = outside.publishers(route.outside)
        fitting = [p for p in publishers if p.topic_type == route.type]
        if not fitting:
            self.finish()
            if publishers:
                self._sides.fail(f"is {publishers[0].topic_type} outside, not {route.type}")
            else:
                self._sides.row.set_state("waiting")
            return
        offers = [from_rclpy(p.qos_profile) for p in fitting]
        if reason := unmet(offers, route.qos):
            self.finish()
            self._sides.fail(reason)
            return
        offer = common_offer(offers, route.qos)
        if self._offer is None or not satisfies(self._offer, offer):
            self.finish()
            if not self._appear(offer):
                return
        listeners = self._sides.inside.subscriptions(route.inside)
        if listeners or route.eager or offer.durability == "transient_local":
            self._listen(max((e.qos.depth for e in listeners), default=1))
        else:
            self.stop_listening()
        self._sides.row.set_state("ready" if self.entity is None else "forwarding")

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
        if self.entity is not None:
            return
        assert self._offer is not None
        request = request_for(self._offer, depth)
        self.entity = self._sides.outside.node.create_subscription(
            self._type,
            self._sides.route.outside,
            never_called,
            to_rclpy(request),
            raw=True,
            event_callbacks=SubscriptionEventCallbacks(use_default_callbacks=False),
        )
        self._reader = RawReader(self.entity)
        self._depth, self._gaps = request.depth, Gaps(self._sides.row)
        self._sides.outside.readers.append(self)

    def stop_listening(self) -> None:
        """Destroy the subscription."""
        if self.entity is None or self._reader is None:
            return
        if self in self._sides.outside.readers:
            self._sides.outside.readers.remove(self)
        self._reader.close()
        self._sides.outside.node.destroy_subscription(self.entity)
        self.entity = self._reader = None

    def pump_outside(self) -> None:
        """Forward messages that have arrived."""
        began_ns = time.thread_time_ns()
        self.take(BATCH)
        self._sides.row.worked(time.thread_time_ns() - began_ns)

    def take(self, limit: int) -> None:
        """Take up to `limit` messages."""
        reader = self._reader
        for _ in range(limit):
            if reader is None or not reader.take():
                return
            info = reader.info
            number, sent_ns = info.publication_sequence_number, info.source_timestamp
            self.arrived(info.publisher, number, reader.address, reader.size, sent_ns)

    def send(self, address: int, size: int, sent_ns: int) -> None:
        """Publish inside with the source timestamp of the DDS publisher."""
        assert self._publisher is not None
        self._publisher.publish_from(address, size, sent_ns)

    def begin_after(self, last: Mapping[bytes, int]) -> None:
        """Count gaps from the sequence numbers of the previous lane."""
        self._gaps.begin_after(last)

    def count_gap(self, publisher: bytes, number: int) -> None:
        """Count messages that DDS did not deliver."""
        self._gaps.note(publisher, number)

    def pause(self) -> None:
        """Stop taking messages."""
        if self in self._sides.outside.readers:
            self._sides.outside.readers.remove(self)

    def resume(self) -> None:
        """Resume after a pause."""
        if self.entity is not None:
            self._sides.outside.readers.append(self)

    def matched_outside(self) -> int:
        """Return the number of DDS publishers that the subscription is matched with."""
        return 0 if self.entity is None else int(self.entity.get_publisher_count())

    def is_acknowledged(self) -> bool:
        """Return True: on the platform, readers have a message as soon as it is published."""
        return True

    def close(self) -> None:
        """Leave both sides."""
        self.stop_listening()
        self._publisher = self._offer = None


def never_called(*_: Any) -> None:
    """Serve as the callback rclpy requires; the bridge takes messages itself."""
