# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""Subscriptions and publishers in a DDS domain, with serialized messages."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

from rclpy.duration import Duration
from rclpy.event_handler import PublisherEventCallbacks, SubscriptionEventCallbacks

from rmw_manycore_bridge.fastdds.domain import Domain
from rmw_manycore_bridge.fastdds.policies import to_rclpy
from rmw_manycore_bridge.fastdds.rcl import RawReader, RawWriter
from rmw_manycore_bridge.outside import types
from rmw_manycore_py.native._transport import EndpointInfo, Qos
from rmw_manycore_py.routes.route import Route


class DdsSubscription:
    """Subscription in a domain."""

    kind = "subscription"

    def __init__(self, domain: Domain, route: Route, qos: Qos) -> None:
        self._domain = domain
        self.entity: Any = domain.node.create_subscription(
            types.load(route.type),
            route.outside,
            never_called,
            to_rclpy(qos),
            raw=True,
            event_callbacks=SubscriptionEventCallbacks(use_default_callbacks=False),
        )
        self._reader = RawReader(self.entity)
        self.take = self._reader.take

    @property
    def publisher(self) -> bytes:
        """Gid of the publisher."""
        return self._reader.info.publisher

    @property
    def number(self) -> int:
        """Sequence number."""
        return int(self._reader.info.publication_sequence_number)

    @property
    def sent_ns(self) -> int:
        """Source timestamp."""
        return int(self._reader.info.source_timestamp)

    @property
    def address(self) -> int:
        """Address of the message."""
        return self._reader.address

    @property
    def size(self) -> int:
        """Size of the message."""
        return self._reader.size

    def matched(self) -> int:
        """Return the number of publishers that it is matched with."""
        return int(self.entity.get_publisher_count())

    def close(self) -> None:
        """Destroy it."""
        self._reader.close()
        self._domain.node.destroy_subscription(self.entity)


class DdsPublisher:
    """Publisher in a domain."""

    def __init__(self, domain: Domain, route: Route, qos: Qos) -> None:
        self._domain, self._topic = domain, route.outside
        self._entity: Any = domain.node.create_publisher(
            types.load(route.type),
            route.outside,
            to_rclpy(qos),
            event_callbacks=PublisherEventCallbacks(use_default_callbacks=False),
        )
        self._writer = RawWriter(self._entity)

    @property
    def gid(self) -> bytes:
        """What subscriptions know it by."""
        return self._writer.gid

    def show(self, _: Sequence[EndpointInfo]) -> None:
        """Nothing: outside, the bridge is the publisher."""

    def resume(self) -> None:
        """Nothing: DDS numbers what is published."""

    def publish(self, address: int, size: int, *_: object) -> None:
        """Publish; rmw sets the source timestamp to now."""
        self._writer.publish(address, size)

    def has_listeners(self) -> bool:
        """Return whether others subscribe to the topic."""
        return bool(self._domain.subscriptions(self._topic))

    def matched(self) -> int:
        """Return the number of subscriptions that it is matched with."""
        return int(self._entity.get_subscription_count())

    def is_acknowledged(self) -> bool:
        """Return whether every reliable subscription has acknowledged everything."""
        return bool(self._entity.wait_for_all_acked(Duration(seconds=0)))

    def close(self) -> None:
        """Destroy it."""
        self._domain.node.destroy_publisher(self._entity)


def never_called(*_: Any) -> None:
    """Serve as the callback rclpy requires; the bridge takes messages itself."""
