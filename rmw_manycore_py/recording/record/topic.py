# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""A recorded topic."""

from __future__ import annotations

from collections.abc import Callable, Sequence

from rmw_manycore_py.native._transport import Qos
from rmw_manycore_py.recording.metadata import TopicRow
from rmw_manycore_py.recording.record.side import Offer, RawSubscription, Side
from rmw_manycore_py.recording.record.writing import Taken, WritingThread
from rmw_manycore_py.ros.qos import all_reliable, all_transient_local


class RecordedTopic:
    """Has one subscription, with QoS compatible with every publisher."""

    def __init__(
        self, row: TopicRow, side: Side, writing: WritingThread, tell: Callable[[str], None]
    ) -> None:
        self.row = row
        self._side, self._writing, self._tell = side, writing, tell
        self._request: Qos | None = None
        self._subscription: RawSubscription | None = None
        self._lost_before = 0  # losses of earlier subscriptions
        self._last: dict[bytes, int] = {}  # last sequence number by publisher

    def follow(self, offers: Sequence[Offer], depth: int) -> None:
        """Subscribe, or resubscribe if a publisher offers less than requested.

        :raises ImportError: if the type is required and not installed.
        """
        self.row.add_offers(offer.qos for offer in offers)
        request = request_for([offer.qos for offer in offers], depth)
        if self._request is not None and _suffices(self._request, request):
            return
        subscription = self._side.subscribe(self.row.name, offers[0], request, self._heard)
        # Messages that arrive meanwhile are in both subscriptions; sequence numbers identify
        # duplicates.
        self._leave()
        self._subscription, self._request = subscription, request
        for policy in mixed_policies([offer.qos for offer in offers]):
            self._tell(f"{self.row.name}: {policy}")

    def _heard(self, data: bytes, published_ns: int, publisher: bytes, number: int) -> None:
        if number <= self._last.get(publisher, -1):
            return
        self._last[publisher] = number
        self._writing.write(
            Taken(self.row, self._side.heard_ns(published_ns), published_ns, number, data)
        )

    def take_rest(self) -> None:
        """Take the messages that have arrived, at most the queue depth."""
        if self._subscription is not None and self._request is not None:
            self._subscription.take(self._request.depth)

    def lost(self) -> int:
        """Return the number of messages known to be lost."""
        subscription = self._subscription
        return self._lost_before + (0 if subscription is None else subscription.lost())

    def close(self) -> None:
        """Destroy the subscription."""
        self._leave()

    def _leave(self) -> None:
        if self._subscription is not None:
            self.take_rest()
            self._subscription.close()
            self._lost_before += self._subscription.lost()
            self._subscription = None


def request_for(offers: Sequence[Qos], depth: int) -> Qos:
    """Return the QoS of the recorder: no stronger than every publisher offers.

    Depths add up, since a late joiner of a latched topic gets the history of each publisher.
    """
    return Qos(
        reliability="reliable" if all_reliable(offers) else "best_effort",
        durability="transient_local" if all_transient_local(offers) else "volatile",
        depth=max(depth, sum(offer.depth for offer in offers)),
    )


def _suffices(present: Qos, wanted: Qos) -> bool:
    """Return whether a subscription matches all publishers that the wanted one would."""
    policies = (
        (present.reliability == "reliable", wanted.reliability == "reliable"),
        (present.durability == "transient_local", wanted.durability == "transient_local"),
    )
    return all(is_wanted or not is_asked for is_asked, is_wanted in policies)


def mixed_policies(offers: Sequence[Qos]) -> list[str]:
    """Return notices about policies that only some publishers offer."""
    said = []
    if len({offer.reliability for offer in offers}) > 1:
        said.append("some publishers offer best effort: requesting best effort from all")
    if len({offer.durability for offer in offers}) > 1:
        said.append("some publishers are volatile: the history of the others is not recorded")
    return said
