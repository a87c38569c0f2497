# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""What a recorder needs of the platform, or of a DDS domain."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import Protocol

from rmw_manycore_py._transport import Qos

# So many messages of one topic are taken before another has its turn.
BATCH = 64


@dataclass(frozen=True)
class Offer:
    """A publisher of a topic."""

    type: str
    type_hash: str
    qos: Qos


# Called with the data of a message, when it was published (ns since 1970), its publisher, and its
# number, which counts up by one for each publisher.
Heard = Callable[[bytes, int, bytes, int], None]


class Ears(Protocol):
    """A subscription."""

    def take(self, limit: int) -> bool:
        """Hand on so many messages at most; tell whether there may be more."""

    def lost(self) -> int:
        """Return how many messages are known to be lost."""

    def close(self) -> None:
        """End it."""


class Side(Protocol):
    """Where topics are. Only `wake` is for other threads."""

    stale: bool  # publishers may have come or gone; cleared by the next look

    def offers(self) -> dict[str, list[Offer]]:
        """Return the publishers there are, by topic."""

    def subscribe(self, topic: str, offer: Offer, request: Qos, heard: Heard) -> Ears:
        """Subscribe to a topic.

        :raises ImportError: when its type is needed, and is not installed.
        """

    def turn(self) -> None:
        """Hand on what has arrived; sleep until there is something, or publishers come or go."""

    def wake(self) -> None:
        """End the present or the next sleep."""

    def close(self) -> None:
        """Leave."""
