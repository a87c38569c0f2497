# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""A topic that is being recorded."""

from __future__ import annotations

import time
from collections.abc import Callable, Sequence

from rmw_manycore_py._transport import Qos
from rmw_manycore_py.qos import all_reliable, all_transient_local
from rmw_manycore_py.recording.metadata import TopicRow
from rmw_manycore_py.recording.record.side import Ears, Offer, Side
from rmw_manycore_py.recording.record.writing import Taken, WritingThread


class RecordedTopic:
    """Has one subscription, which asks for no more than every publisher offers."""

    def __init__(
        self, row: TopicRow, side: Side, writing: WritingThread, tell: Callable[[str], None]
    ) -> None:
        self.row = row
        self._side, self._writing, self._tell = side, writing, tell
        self._request: Qos | None = None
        self._ears: Ears | None = None
        self._lost_before = 0  # by earlier subscriptions
        self._last: dict[bytes, int] = {}  # numbers, by publisher

    def follow(self, offers: Sequence[Offer], depth: int) -> None:
        """Subscribe, or anew where a publisher offers less than is asked for.

        :raises ImportError: when the type is needed, and is not installed.
        """
        self.row.add_offers(offer.qos for offer in offers)
        request = request_for([offer.qos for offer in offers], depth)
        if self._request is not None and _suffices(self._request, request):
            return
        ears = self._side.subscribe(self.row.name, offers[0], request, self._heard)
        # What came meanwhile is in both; the numbers tell.
        self._leave()
        self._ears, self._request = ears, request
        for policy in mixed_policies([offer.qos for offer in offers]):
            self._tell(f"{self.row.name}: {policy}")

    def _heard(self, data: bytes, published_ns: int, publisher: bytes, number: int) -> None:
        if number <= self._last.get(publisher, -1):
            return
        self._last[publisher] = number
        self._writing.write(Taken(self.row, time.time_ns(), published_ns, number, data))

    def take_rest(self) -> None:
        """Take what has arrived by now: no more than the subscription keeps."""
        if self._ears is not None and self._request is not None:
            self._ears.take(self._request.depth)

    def lost(self) -> int:
        """Return how many messages are known to be lost."""
        ears = self._ears
        return self._lost_before + (0 if ears is None else ears.lost())

    def close(self) -> None:
        """End the subscription."""
        self._leave()

    def _leave(self) -> None:
        if self._ears is not None:
            self.take_rest()
            self._ears.close()
            self._lost_before += self._ears.lost()
            self._ears = None


def request_for(offers: Sequence[Qos], depth: int) -> Qos:
    """Return what a recorder asks for: no more than every publisher offers.

    A late subscriber of a latched topic gets what each publisher has kept, so depths add up.
    """
    return Qos(
        reliability="reliable" if all_reliable(offers) else "best_effort",
        durability="transient_local" if all_transient_local(offers) else "volatile",
        depth=max(depth, sum(offer.depth for offer in offers)),
    )


def _suffices(present: Qos, wanted: Qos) -> bool:
    """Tell whether a subscription hears all publishers that the wanted one would hear."""
    policies = (
        (present.reliability == "reliable", wanted.reliability == "reliable"),
        (present.durability == "transient_local", wanted.durability == "transient_local"),
    )
    return all(is_wanted or not is_asked for is_asked, is_wanted in policies)


def mixed_policies(offers: Sequence[Qos]) -> list[str]:
    """Return what to say of policies that only some publishers offer."""
    said = []
    if len({offer.reliability for offer in offers}) > 1:
        said.append("some publishers offer best effort: asking all for best effort")
    if len({offer.durability for offer in offers}) > 1:
        said.append("some publishers keep nothing: what the others kept is not recorded")
    return said
