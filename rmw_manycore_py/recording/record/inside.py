# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""The platform's side of a recorder: a member process without ROS."""

from __future__ import annotations

import os
import threading

from rmw_manycore_py import _transport
from rmw_manycore_py._transport import Qos
from rmw_manycore_py.native_errors import translate_native_errors
from rmw_manycore_py.recording.place import own_cluster
from rmw_manycore_py.recording.record.side import BATCH, Ears, Heard, Offer


class Inside:
    """Sleeps on the process's wake word."""

    def __init__(self, platform: str) -> None:
        label = f"_manycore_record_{os.getpid()}"
        with translate_native_errors():
            self._process = _transport.Process(platform, own_cluster(), None, label)
            self._view = _transport.Platform(platform)
        self._process.watch_graph()
        self._generation = self._process.graph_generation()
        self._ears: list[_InsideEars] = []
        self._woken = threading.Event()
        self.stale = True

    def offers(self) -> dict[str, list[Offer]]:
        """Return the publishers there are, by topic."""
        found: dict[str, list[Offer]] = {}
        with translate_native_errors():
            for endpoint in self._view.endpoints():
                if (endpoint.role, endpoint.kind) == ("topic", "publisher"):
                    offer = Offer(endpoint.type, endpoint.type_hash, endpoint.qos)
                    found.setdefault(endpoint.topic, []).append(offer)
        return found

    def subscribe(self, topic: str, offer: Offer, request: Qos, heard: Heard) -> Ears:
        """Subscribe to a topic; its type need not be installed."""
        with translate_native_errors():
            subscription = self._process.subscription(
                topic, offer.type, request, type_hash=offer.type_hash
            )
        ears = _InsideEars(subscription, heard, self._ears)
        self._ears.append(ears)
        return ears

    def turn(self) -> None:
        """Hand on what has arrived; sleep until there is something, or publishers come or go."""
        seen = self._process.epoch()
        if self._woken.is_set():
            self._woken.clear()
            return
        is_busy = sum(ears.take(BATCH) for ears in self._ears) > 0
        generation = self._process.graph_generation()
        if generation != self._generation:
            self._generation = generation
            self.stale = True
        elif not is_busy:
            self._process.wait(seen)

    def wake(self) -> None:
        """End the present or the next sleep."""
        self._woken.set()
        self._process.notify()

    def close(self) -> None:
        """Leave the platform."""
        for ears in list(self._ears):
            ears.close()
        self._view.close()
        self._process.close()


class _InsideEars:
    """A subscription on the platform."""

    def __init__(
        self,
        subscription: _transport.Subscription,
        heard: Heard,
        among: list[_InsideEars],
    ) -> None:
        self._subscription: _transport.Subscription | None = subscription
        self._heard, self._among = heard, among
        self._lost = 0

    def take(self, limit: int) -> bool:
        """Hand on so many messages at most; tell whether there may be more."""
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
        """Return how many messages are known to be lost."""
        if self._subscription is not None:
            self._lost = self._subscription.lost()
        return self._lost

    def close(self) -> None:
        """End the subscription."""
        self.lost()
        self._subscription = None
        if self in self._among:
            self._among.remove(self)
