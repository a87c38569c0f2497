# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""Find the map that the page of `manycore view` shows beneath the clouds of a topic."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from functools import partial
from typing import Any

from rmw_manycore_py.cli.topic.cloud_samples import MAX_MAP_POINTS, Row, cloud_of
from rmw_manycore_py.cli.topic.listening import Listener
from rmw_manycore_py.cli.topic.qos_options import QosOptions

CLOUD = "sensor_msgs/msg/PointCloud2"


class MapSearch:
    """Subscribes to latched clouds, one more per look, until one is in the frame of the clouds.

    Only that subscription is kept. Its newest map is shown at the next look.
    """

    def __init__(self, listener: Listener, show: Callable[[Row], None]) -> None:
        self._listener, self._show = listener, show
        self._frame: str | None = None  # of the clouds; none yet
        self._cancels: dict[str, Callable[[], None]] = {}  # of the subscriptions, by topic
        self._newest: dict[str, Any] = {}  # messages since the previous look, by topic
        self._rejected: set[str] = set()  # topics in other frames
        self._shown: Row | None = None

    def belong_to(self, frame: str) -> None:
        """Search in the frame of the clouds; anew if it is another one."""
        if frame != self._frame:
            self._keep_only(None)
            self._frame, self._newest, self._rejected, self._shown = frame, {}, set(), None

    def look(self, topics: Sequence[str]) -> None:
        """Show a new map; without one, subscribe to the next of these topics."""
        if self._frame is None:
            return
        self._rejected &= set(topics)  # a publisher that comes again may have another frame
        newest, self._newest = self._newest, {}
        for topic, message in newest.items():
            if topic in self._cancels:
                self._consider(topic, message)
        if self._shown is None:
            self._subscribe_to_one(topics)

    def _consider(self, topic: str, message: Any) -> None:
        if message.header.frame_id != self._frame:
            self._cancels.pop(topic)()
            self._rejected.add(topic)
            self._hide()
            return
        row = {"topic": topic, **cloud_of(message, MAX_MAP_POINTS)}
        if "points" not in row:  # cleared, or damaged
            self._hide()
        elif row != self._shown:  # some maps are published over and over
            self._keep_only(topic)
            self._shown = row
            self._show({"map": row})

    def _hide(self) -> None:
        """Show no map any longer: that of another topic has no subscription."""
        if self._shown is not None:
            self._shown = None
            self._show({"map": None})

    def _keep_only(self, topic: str | None) -> None:
        for other in self._cancels.keys() - {topic}:
            self._cancels.pop(other)()

    def _subscribe_to_one(self, topics: Sequence[str]) -> None:
        for topic in topics:
            if topic not in self._cancels and topic not in self._rejected:
                self._cancels[topic] = self._listener.also(
                    topic, CLOUD, partial(self._hear, topic), QosOptions(depth=1)
                )
                return

    def _hear(self, topic: str, message: Any) -> None:
        self._newest[topic] = message
