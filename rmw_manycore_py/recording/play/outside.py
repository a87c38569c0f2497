# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""Plays in a DDS domain: rclpy on Fast DDS, with serialized messages."""

from __future__ import annotations

import os
from typing import Any

from rclpy.duration import Duration
from rclpy.event_handler import PublisherEventCallbacks

from rmw_manycore_bridge.fastdds.domain import Domain
from rmw_manycore_bridge.fastdds.policies import to_rclpy
from rmw_manycore_bridge.outside import types
from rmw_manycore_py.native._transport import Qos
from rmw_manycore_py.recording.play.stage import RawPublisher
from rmw_manycore_py.recording.type_hash import type_hash_of
from rmw_manycore_py.ros.domain import ros_domain

# Maximum wait for reliable subscribers at the end.
_TIMEOUT = Duration(seconds=1)


class Outside:
    """Publishes in the domain; requires the types to be installed."""

    def __init__(self) -> None:
        name = f"_manycore_play_{os.getpid()}"
        self._domain = Domain(ros_domain(), name, lambda: None, lambda _: False)
        self._publishers: list[Any] = []

    def types_of(self, topic: str) -> dict[str, str]:
        """Return the types used by others on a topic, as far as discovered."""
        others = [*self._domain.publishers(topic), *self._domain.subscriptions(topic)]
        return {other.topic_type: type_hash_of(other) for other in others}

    def publisher(self, topic: str, type_name: str, type_hash: str, qos: Qos) -> RawPublisher:
        """Create a publisher.

        :raises ImportError: if its type is not installed, or has another hash.
        """
        installed = types.hash_of(type_name)
        if installed and type_hash not in ("", installed):
            raise ImportError(
                f"{type_name} has another definition here: {installed}, not {type_hash}"
            )
        publisher = self._domain.node.create_publisher(
            types.load(type_name),
            topic,
            to_rclpy(qos),
            event_callbacks=PublisherEventCallbacks(use_default_callbacks=False),
        )
        self._publishers.append(publisher)
        raw: RawPublisher = publisher  # rclpy publishers accept serialized messages
        return raw

    def close(self) -> None:
        """Leave after reliable subscribers have acknowledged everything."""
        for publisher in self._publishers:
            publisher.wait_for_all_acked(_TIMEOUT)
        self._domain.close()
