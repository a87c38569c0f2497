# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""Interface of a recorder to the platform or a DDS domain."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import Protocol

from rmw_manycore_py.native._transport import Qos

# Messages taken of one topic before the next topic's turn.
BATCH = 64


@dataclass(frozen=True)
class Offer:
    """A publisher of a topic."""

    type: str
    type_hash: str
    qos: Qos


# Called with the data of a message, its source timestamp (ns since 1970), its publisher, and its
# sequence number, which increases by one per message of a publisher.
Heard = Callable[[bytes, int, bytes, int], None]


class RawSubscription(Protocol):
    """A subscription."""

    def take(self, limit: int) -> bool:
        """Deliver up to `limit` messages; return whether there may be more."""

    def lost(self) -> int:
        """Return the number of messages known to be lost."""

    def close(self) -> None:
        """Destroy the subscription."""


class Side(Protocol):
    """Source of topics. Only `wake` may be called by other threads."""

    stale: bool  # publishers may have changed; cleared by the next check

    def offers(self) -> dict[str, list[Offer]]:
        """Return the publishers by topic."""

    def subscribe(self, topic: str, offer: Offer, request: Qos, heard: Heard) -> RawSubscription:
        """Subscribe to a topic.

        :raises ImportError: if its type is required and not installed.
        """

    def heard_ns(self, published_ns: int, /) -> int:
        """Return the time, since 1970, at which a message is heard; now."""

    def turn(self) -> None:
        """Deliver arrived messages; block until there are more, or publishers change."""

    def wake(self) -> None:
        """Interrupt the current or next wait."""

    def close(self) -> None:
        """Leave the platform or domain."""
