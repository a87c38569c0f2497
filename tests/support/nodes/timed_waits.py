# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""Nodes that wait for an image, which is long under way, and for more: `timed_waits.py NODE`.

They print what has ended a wait, and when, in ms.
"""

from __future__ import annotations

import sys
import threading
import time
from contextlib import suppress
from typing import Any

import rclpy
from rclpy.duration import Duration
from rclpy.event_handler import SubscriptionEventCallbacks
from rclpy.executors import ExternalShutdownException
from rclpy.node import Node
from rclpy.qos import QoSProfile
from std_msgs.msg import String
from std_srvs.srv import Trigger

IMAGE_PERIOD_S = 0.1
TRIGGERED_AFTER_S = 0.11
ASKED_AFTER_S = 0.12
DEADLINE_S = 0.13
_START_NS = 10**18


def _say(what: str) -> None:
    print(what, round((time.time_ns() - _START_NS) / 1e6), flush=True)


class Camera(Node):
    """Publishes images."""

    def __init__(self) -> None:
        super().__init__("camera")
        publisher = self.create_publisher(String, "image", 10)
        self.create_timer(IMAGE_PERIOD_S, lambda: publisher.publish(String()))


class Filter(Node):
    """Waits for images, a guard condition, a service, and the deadline of a silent topic."""

    def __init__(self) -> None:
        super().__init__("filter")
        self.create_subscription(String, "image", lambda _: _say("image"), 10)
        self._guard = self.create_guard_condition(lambda: _say("triggered"))
        self.create_service(Trigger, "ask", self._answer)
        self._listen_to_silence()
        threading.Thread(target=self._trigger, daemon=True).start()

    def _listen_to_silence(self) -> None:
        qos = QoSProfile(depth=1, deadline=Duration(seconds=DEADLINE_S))
        events = SubscriptionEventCallbacks(deadline=lambda _: _say("missed"))
        publisher = self.create_publisher(String, "silence", qos)
        self.create_subscription(
            String, "silence", lambda _: _say("silence"), qos, event_callbacks=events
        )
        publisher.publish(String())

    def _trigger(self) -> None:
        time.sleep(TRIGGERED_AFTER_S)
        self._guard.trigger()

    def _answer(self, _: Any, answer: Any) -> Any:
        _say("asked")
        return answer


class Sink(Node):
    """Asks the filter, once, while an image is under way to itself, too."""

    def __init__(self) -> None:
        super().__init__("sink")
        self.create_subscription(String, "image", lambda _: _say("image"), 10)
        self._client = self.create_client(Trigger, "ask")
        self._timer = self.create_timer(ASKED_AFTER_S, self._ask)

    def _ask(self) -> None:
        self._timer.cancel()
        future = self._client.call_async(Trigger.Request())
        future.add_done_callback(lambda _: _say("answered"))


KINDS = {kind.__name__.lower(): kind for kind in (Camera, Filter, Sink)}


def main() -> None:
    """Spin the node that the first argument names."""
    rclpy.init()
    with suppress(KeyboardInterrupt, ExternalShutdownException):
        rclpy.spin(KINDS[sys.argv[1]]())


if __name__ == "__main__":
    main()
