# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""Records in a DDS domain: rclpy on Fast DDS, with serialized messages."""

from __future__ import annotations

import ctypes
import os
import time
from typing import Any

from rclpy.event_handler import SubscriptionEventCallbacks

from rmw_manycore_bridge.fastdds.domain import Domain
from rmw_manycore_bridge.fastdds.policies import from_rclpy, to_rclpy
from rmw_manycore_bridge.fastdds.rcl import RawReader
from rmw_manycore_bridge.outside import types
from rmw_manycore_py.native._transport import Qos
from rmw_manycore_py.recording.record.side import BATCH, Heard, Offer, RawSubscription
from rmw_manycore_py.recording.type_hash import type_hash_of
from rmw_manycore_py.ros.domain import ros_domain


class Outside:
    """Blocks on a wait set, woken by messages and graph changes."""

    def __init__(self) -> None:
        self._domain = Domain(
            ros_domain(), f"_manycore_record_{os.getpid()}", self._changed, lambda _: False
        )
        self.stale = True

    def heard_ns(self, _published_ns: int, /) -> int:
        """Return now."""
        return time.time_ns()

    def _changed(self) -> None:
        self.stale = True

    def offers(self) -> dict[str, list[Offer]]:
        """Return the publishers by topic."""
        return {
            topic: [_offer(publisher) for publisher in self._domain.publishers(topic)]
            for topic in self._domain.published(lambda _: True)
        }

    def subscribe(self, topic: str, offer: Offer, request: Qos, heard: Heard) -> RawSubscription:
        """Subscribe to a topic.

        :raises ImportError: if its type is not installed.
        """
        return _Subscription(self._domain, topic, types.load(offer.type), request, heard)

    def turn(self) -> None:
        """Deliver arrived messages; block until there are more, or publishers change."""
        self._domain.turn(None)

    def wake(self) -> None:
        """Interrupt the current or next wait."""
        self._domain.wake()

    def close(self) -> None:
        """Leave the domain."""
        self._domain.close()


def _offer(publisher: Any) -> Offer:
    qos = from_rclpy(publisher.qos_profile)
    return Offer(publisher.topic_type, type_hash_of(publisher), qos)


class _Subscription:
    """Subscription in the domain."""

    kind = "subscription"

    def __init__(
        self, domain: Domain, topic: str, message_type: Any, request: Qos, heard: Heard
    ) -> None:
        self._domain, self._heard = domain, heard
        self.entity: Any = domain.node.create_subscription(
            message_type,
            topic,
            _never_called,
            to_rclpy(request),
            raw=True,
            event_callbacks=SubscriptionEventCallbacks(use_default_callbacks=False),
        )
        self._reader = RawReader(self.entity)
        self._last: dict[bytes, int] = {}  # last sequence number by publisher
        self._lost = 0
        domain.readers[self] = self.pump_outside

    def pump_outside(self) -> None:
        """Deliver a batch; the wait set returns at once while there are more."""
        self.take(BATCH)

    def take(self, limit: int) -> bool:
        """Deliver up to `limit` messages; return whether there may be more."""
        reader = self._reader
        for _ in range(limit):
            if self.entity is None or not reader.take():
                return False
            info = reader.info
            publisher, number = info.publisher, int(info.publication_sequence_number)
            self._count_gap(publisher, number)
            data = ctypes.string_at(reader.address, reader.size)
            self._heard(data, int(info.source_timestamp), publisher, number)
        return True

    def _count_gap(self, publisher: bytes, number: int) -> None:
        last = self._last.get(publisher)
        if last is not None and number > last + 1:
            self._lost += number - last - 1
        self._last[publisher] = max(number, last or 0)

    def lost(self) -> int:
        """Return the number of gaps in sequence numbers."""
        return self._lost

    def close(self) -> None:
        """Destroy the subscription."""
        if self.entity is not None:
            del self._domain.readers[self]
            self._reader.close()
            self._domain.node.destroy_subscription(self.entity)
            self.entity = None


def _never_called(*_: Any) -> None:
    """Serve as the callback rclpy requires; messages are taken from the subscription."""
