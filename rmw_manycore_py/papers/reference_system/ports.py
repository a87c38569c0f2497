# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""Inputs and outputs of a node, with counters of lost and missed messages."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from typing import Any

from rclpy.callback_groups import CallbackGroup
from rclpy.node import Node
from rclpy.qos import HistoryPolicy, QoSProfile

from rmw_manycore_py.papers.reference_system.payload import RESULT, check_payload, write_payload
from rmw_manycore_py.papers.reference_system.sample import (
    Gaps,
    add_record,
    merge_records,
    now_ns,
    sequence_of,
)
from rmw_manycore_py.papers.reference_system.settings import KEEP_ALL, Settings

NS_PER_S = 1e9
# Minimum time between loss reports, to limit their cost in an overloaded node.
LOSSES_SAID_EVERY_NS = 0.1 * NS_PER_S


def qos(depth: int) -> QoSProfile:
    """Return a reliable QoS with this depth; 0 keeps all."""
    if depth == KEEP_ALL:
        return QoSProfile(history=HistoryPolicy.KEEP_ALL)
    return QoSProfile(depth=depth)


class Input:
    """A subscription; `missed` counts messages the node skipped, `lost` those not received."""

    def __init__(
        self,
        node: Node,
        settings: Settings,
        topic: str,
        callback: Callable[[Input, Any], None],
        group: CallbackGroup | None,
    ) -> None:
        self.cached: Any = None
        self._topic = topic
        self._checked = settings.checked
        self._callback = callback
        self._processed = Gaps()
        self._received = Gaps()
        self._lost = 0
        self._said_ns = 0
        node.create_subscription(
            settings.message, topic, self._receive, qos(settings.depth), callback_group=group
        )

    def _receive(self, message: Any) -> None:
        self._lost += self._received.before(sequence_of(message))
        if self._lost and now_ns() > self._said_ns + LOSSES_SAID_EVERY_NS:
            self.report_losses()
        if self._checked:
            check_payload(message, self._topic)
        self._callback(self, message)

    def missed(self, message: Any) -> int:
        """Return the number of messages skipped since the last processed one."""
        return self._processed.before(sequence_of(message))

    def report_losses(self) -> None:
        """Print how many messages of the topic were lost, if any."""
        if self._lost:
            self._said_ns = now_ns()
            print(f"lost {self._lost} of {self._topic} at {self._said_ns}", flush=True)
            self._lost = 0


class Output:
    """A publisher that reuses one message."""

    def __init__(self, node: Node, settings: Settings, topic: str) -> None:
        self._name = node.get_name()
        self._checked = settings.checked
        self._message = settings.message()
        self._sequence = 0
        self._publisher = node.create_publisher(settings.message, topic, qos(settings.depth))

    def publish(
        self, timestamp_ns: int, sources: Sequence[Any] = (), missed: int = 0, result: int = 0
    ) -> None:
        """Publish the records of all sources, followed by this node's."""
        message = self._message
        message.size = 0
        for source in sources:
            merge_records(message, source)
        add_record(message, self._name, timestamp_ns, self._sequence, missed)
        message.data[RESULT] = result
        if self._checked:
            write_payload(message, self._sequence)
        self._sequence += 1
        self._publisher.publish(message)
