# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""An rclpy node on the platform that listens to one topic, for `topic echo` and `topic hz`.

rclpy is imported late: the other commands do without it, and it must find rmw_manycore loaded.
"""

from __future__ import annotations

import importlib
import os
from collections.abc import Callable, Iterable
from contextlib import suppress
from typing import Any

from rmw_manycore_py import _transport
from rmw_manycore_py.cli import view
from rmw_manycore_py.cli.view import Row
from rmw_manycore_py.errors import EXIT_BAD_INPUT, ManycoreError

DEPTH = 10


class Listener:
    """Subscribes to a topic of a platform, as its publishers offer it."""

    def __init__(
        self,
        platform: str,
        topic: str,
        type_name: str | None,
        heard: Callable[[Any], None],
        *,
        raw: bool = False,
    ) -> None:
        endpoints = _endpoints(platform, topic)
        message_type = load_type(type_name or type_of_topic(topic, endpoints))
        os.environ["MANYCORE_PLATFORM"] = platform
        import rclpy

        rclpy.init(args=[])
        self._rclpy = rclpy
        self._over = False
        self._node = rclpy.create_node(
            f"_manycore_{os.getpid()}", enable_rosout=False, start_parameter_services=False
        )
        self._node.create_subscription(message_type, topic, heard, _qos(endpoints), raw=raw)

    def every(self, period_s: float, call: Callable[[], None]) -> None:
        """Call something once per period."""
        self._node.create_timer(period_s, call)

    def stop(self) -> None:
        """End `run` after the present message."""
        self._over = True

    def run(self) -> None:
        """Listen until stopped or interrupted."""
        from rclpy.executors import ExternalShutdownException

        with suppress(KeyboardInterrupt, ExternalShutdownException):
            while not self._over:
                self._rclpy.spin_once(self._node)
        self._node.destroy_node()
        self._rclpy.try_shutdown()


def type_of_topic(topic: str, endpoints: Iterable[Row]) -> str:
    """Return the one type of a topic."""
    types: list[str] = sorted({endpoint["type"] for endpoint in endpoints})
    if not types:
        raise ManycoreError(f"nobody uses the topic '{topic}' yet; give its type to wait for it")
    if len(types) > 1:
        raise ManycoreError(f"'{topic}' has several types, give one: {', '.join(types)}")
    return types[0]


def load_type(name: str) -> Any:
    """Return the class of a message type, package/msg/Name."""
    parts = name.split("/")
    if len(parts) != 3 or parts[1] not in ("msg", "srv", "action"):
        raise ManycoreError(
            f"'{name}' is no message type: expected package/msg/Name", EXIT_BAD_INPUT
        )
    try:
        return getattr(importlib.import_module(f"{parts[0]}.{parts[1]}"), parts[2])
    except (ImportError, AttributeError) as error:
        raise ManycoreError(f"message type '{name}' is not installed: {error}") from error


def _endpoints(platform: str, topic: str) -> list[Row]:
    if platform not in _transport.platforms():
        return []
    return view.endpoints_of_topic(view.open_platform(platform).endpoints(), topic)


def offered_policies(endpoints: Iterable[Row]) -> tuple[bool, bool]:
    """Return whether all publishers of a topic are reliable, and whether all keep messages."""
    offers = [e["qos"] for e in endpoints if e["kind"] == "publisher"]
    reliable = all(qos["reliability"] == "reliable" for qos in offers)
    kept = bool(offers) and all(qos["durability"] == "transient_local" for qos in offers)
    return reliable, kept


def _qos(endpoints: Iterable[Row]) -> Any:
    """Ask for no more than every publisher offers, so that all are heard."""
    from rclpy.qos import DurabilityPolicy, QoSProfile, ReliabilityPolicy

    reliable, kept = offered_policies(endpoints)
    return QoSProfile(
        depth=DEPTH,
        reliability=ReliabilityPolicy.RELIABLE if reliable else ReliabilityPolicy.BEST_EFFORT,
        durability=DurabilityPolicy.TRANSIENT_LOCAL if kept else DurabilityPolicy.VOLATILE,
    )
