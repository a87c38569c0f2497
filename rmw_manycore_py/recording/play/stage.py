# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""What a player needs of the platform, or of a DDS domain."""

from __future__ import annotations

from typing import Protocol

from rmw_manycore_py._transport import Qos


class Voice(Protocol):
    """A publisher."""

    def publish(self, data: bytes) -> None:
        """Publish a serialized message."""


class Stage(Protocol):
    """Where topics are played to."""

    def types_of(self, topic: str) -> dict[str, str]:
        """Return the types that others have of a topic, each with its hash, "" if unknown."""

    def publisher(self, topic: str, type_name: str, type_hash: str, qos: Qos) -> Voice:
        """Return a publisher.

        :raises ImportError: when its type is needed, and is not installed.
        """

    def close(self) -> None:
        """Leave, once reliable subscribers have what was published."""
