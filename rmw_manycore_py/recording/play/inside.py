# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""Plays on the platform, as a member process without ROS."""

from __future__ import annotations

import os

from rmw_manycore_py.native import _transport
from rmw_manycore_py.native._transport import Qos
from rmw_manycore_py.native.errors import translate_native_errors
from rmw_manycore_py.platform.environment import own_cluster
from rmw_manycore_py.recording.play.stage import RawPublisher


class Inside:
    """Publishes recorded messages as they are; types need not be installed."""

    def __init__(self, platform: str) -> None:
        with translate_native_errors():
            label = f"_manycore_play_{os.getpid()}"
            self._process = _transport.Process(platform, own_cluster(), None, label)

    def types_of(self, topic: str) -> dict[str, str]:
        """Return the types used by others on a topic, with their hashes ("" if unknown)."""
        with translate_native_errors():
            endpoints = self._process.endpoints_of(topic)
        return {e.type: e.type_hash for e in endpoints if e.role == "topic"}

    def publisher(self, topic: str, type_name: str, type_hash: str, qos: Qos) -> RawPublisher:
        """Create a publisher."""
        with translate_native_errors(topic):
            return _Publisher(
                topic, self._process.publisher(topic, type_name, qos, type_hash=type_hash)
            )

    def close(self) -> None:
        """Leave the platform; subscriptions already have all published messages."""
        self._process.close()


class _Publisher:
    def __init__(self, topic: str, publisher: _transport.Publisher) -> None:
        self._topic, self._publisher = topic, publisher

    def publish(self, data: bytes) -> None:
        with translate_native_errors(self._topic):
            self._publisher.publish(data)
