# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""Interface of a player to the platform or a DDS domain."""

from __future__ import annotations

from typing import Protocol

from rmw_manycore_py.native._transport import Qos


class RawPublisher(Protocol):
    """A publisher."""

    def publish(self, data: bytes) -> None:
        """Publish a serialized message."""


class Stage(Protocol):
    """Destination of played topics."""

    def types_of(self, topic: str) -> dict[str, str]:
        """Return the types used by others on a topic, with their hashes ("" if unknown)."""

    def publisher(self, topic: str, type_name: str, type_hash: str, qos: Qos) -> RawPublisher:
        """Create a publisher.

        :raises ImportError: if its type is required and not installed.
        """

    def close(self) -> None:
        """Leave after reliable subscribers have received everything."""
