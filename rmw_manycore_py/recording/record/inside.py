# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""Records on the platform, as a member process without ROS."""

from __future__ import annotations

import os
import threading
import time

from rmw_manycore_py.native import _transport
from rmw_manycore_py.native._transport import Qos
from rmw_manycore_py.native.errors import translate_native_errors
from rmw_manycore_py.platform.environment import own_cluster
from rmw_manycore_py.platform.virtual_clock import virtual_clock
from rmw_manycore_py.recording.record.side import BATCH, Heard, Offer, RawSubscription


class Inside:
    """Blocks on the process's wake word."""

    def __init__(self, platform: str) -> None:
        label = f"_manycore_record_{os.getpid()}"
        with translate_native_errors():
            self._process = _transport.Process(platform, own_cluster(), None, label)
        self._process.watch_graph()
        self._generation = self._process.graph_generation()
        self._subscriptions: list[_Subscription] = []
        self._woken = threading.Event()
        self._is_virtual = virtual_clock(platform) is not None
        self.stale = True

    def heard_ns(self, published_ns: int, /) -> int:
        """Return now; in virtual time, in which messages are there at once, when it was published.

        The recorder lives in wall time.
        """
        return published_ns if self._is_virtual else time.time_ns()

    def offers(self) -> dict[str, list[Offer]]:
        """Return the publishers by topic."""
        found: dict[str, list[Offer]] = {}
        with translate_native_errors():
            for endpoint in self._process.endpoints():
                if (endpoint.role, endpoint.kind) == ("topic", "publisher"):
                    offer = Offer(endpoint.type, endpoint.type_hash, endpoint.qos)
                    found.setdefault(endpoint.topic, []).append(offer)
        return found

    def subscribe(self, topic: str, offer: Offer, request: Qos, heard: Heard) -> RawSubscription:
        """Subscribe to a topic; its type need not be installed."""
        with translate_native_errors():
            native = self._process.subscription(
                topic, offer.type, request, type_hash=offer.type_hash
            )
        subscription = _Subscription(native, heard, self._subscriptions)
        self._subscriptions.append(subscription)
        return subscription

    def turn(self) -> None:
        """Deliver arrived messages; block until there are more, or publishers change."""
        seen = self._process.epoch()
        if self._woken.is_set():
            self._woken.clear()
            return
        is_busy = sum(subscription.take(BATCH) for subscription in self._subscriptions) > 0
        generation = self._process.graph_generation()
        if generation != self._generation:
            self._generation = generation
            self.stale = True
        elif not is_busy:
            self._process.wait(seen)

    def wake(self) -> None:
        """Interrupt the current or next wait."""
        self._woken.set()
        self._process.notify()

    def close(self) -> None:
        """Leave the platform."""
        for subscription in list(self._subscriptions):
            subscription.close()
        self._process.close()


class _Subscription:
    """Subscription on the platform."""

    def __init__(
        self,
        subscription: _transport.Subscription,
        heard: Heard,
        among: list[_Subscription],
    ) -> None:
        self._subscription: _transport.Subscription | None = subscription
        self._heard, self._among = heard, among
        self._lost = 0

    def take(self, limit: int) -> bool:
        """Deliver up to `limit` messages; return whether there may be more."""
        for _ in range(limit):
            if self._subscription is None or (claim := self._subscription.claim()) is None:
                return False
            try:
                data, sent_ns = claim.data, claim.source_timestamp_ns
                publisher, number = claim.publisher, claim.sequence
            finally:
                claim.release()
            self._heard(data, sent_ns, publisher, number)
        return True

    def lost(self) -> int:
        """Return the number of messages known to be lost."""
        if self._subscription is not None:
            self._lost = self._subscription.lost()
        return self._lost

    def close(self) -> None:
        """Destroy the subscription."""
        self.lost()
        self._subscription = None
        if self in self._among:
            self._among.remove(self)
