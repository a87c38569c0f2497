# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""Clouds as the page of `manycore view` shows them, with their map and their judgement."""

from __future__ import annotations

from base64 import b64encode
from collections.abc import Callable, Iterable
from functools import partial
from typing import Any

import numpy as np

from rmw_manycore_py.cli.common import view
from rmw_manycore_py.cli.common.message_text import shortened
from rmw_manycore_py.cli.topic.listening import Listener, offered_policies
from rmw_manycore_py.cli.topic.qos_options import QosOptions
from rmw_manycore_py.native._transport import EndpointInfo
from rmw_manycore_py.ros.names import expand, full_node_name

Row = dict[str, Any]

_CLOUD = "sensor_msgs/msg/PointCloud2"
_DIAGNOSTICS = ("/diagnostics", "diagnostic_msgs/msg/DiagnosticArray")
MAX_POINTS = 20_000
MAX_MAP_POINTS = 100_000
MAX_TEXT = 300  # characters of a text from a message; the viewer reads lines of limited length
_ALL_REPORTS = QosOptions(depth=100)  # also of the time that a large cloud takes
_LOOK_PERIOD_S = 1.0
_STATUS = "scan_matching_status"  # of Autoware's matcher and ours
# Needed fields of a PointCloud2, and of other messages like it.
_FIELDS = {
    "header": "std_msgs/Header",
    "fields": "sequence<sensor_msgs/PointField>",
    "is_bigendian": "boolean",
    **dict.fromkeys(("height", "width", "point_step", "row_step"), "uint32"),
    "data": "sequence<uint8>",
}


def is_cloud(message: Any) -> bool:
    """Return whether a message is a PointCloud2."""
    return bool(_FIELDS.items() <= message.get_fields_and_field_types().items())


def cloud_of(message: Any, max_count: int = MAX_POINTS) -> Row:
    """Return at most `max_count` points of a cloud, or under `problem` why there are none.

    `points` are float32 (N, 3) in base64, relative to `origin` and lowest first, since higher ones
    cover them seen from above; `heights` is the range of colours.
    """
    # Loaded when needed: other topics do not wait for the matcher's package.
    from rmw_manycore_py.ndt.messages.point_cloud import CloudError, decode

    count = message.width * message.height
    row: Row = {"frame": shortened(message.header.frame_id, MAX_TEXT), "count": count}
    if count == 0:
        return {**row, "problem": "the cloud is empty"}
    try:
        points = decode(message, max_count)
    except CloudError as error:
        return {**row, "problem": shortened(str(error), MAX_TEXT)}
    if len(points) == 0:
        return {**row, "problem": f"none of {count} points has a finite position"}
    points = points[np.argsort(points[:, 2])].astype(np.float64)
    origin = np.floor(np.median(points, axis=0))  # float32 is coarse far away
    return {
        **row,
        "shown": len(points),
        "origin": origin.tolist(),
        "points": b64encode((points - origin).astype("<f4").tobytes()).decode(),
        "heights": np.percentile(points[:, 2], (2, 98)).tolist(),
    }


def judgement_of(status: Any) -> Row:
    """Return what a matcher says of its newest scan, and whether it believes the pose."""
    values = {pair.key: pair.value for pair in status.values}
    message = shortened(status.message, MAX_TEXT)
    if "skipping_publish_num" not in values:  # not matched, since a newer scan has arrived
        return {"text": message, "believed": False}
    if values["skipping_publish_num"] != "0" or values.get("is_activated") != "True":
        return {"text": f"refused: {message}", "believed": False}
    remark = "" if message in ("", "OK") else f", but {message}"
    return {"text": f"believed{remark}", "believed": True}


class Surroundings:
    """Subscribes to what is shown with the clouds of a topic: a latched map, a matcher's report."""

    def __init__(
        self, listener: Listener, platform: str, topic: str, show: Callable[[Row], None]
    ) -> None:
        self._listener, self._platform = listener, platform
        self._topic, self._show = expand(topic, "/"), show
        self._frame: str | None = None  # of the clouds; none yet
        self._has_map = self._has_reports = False
        self._asked: set[str] = set()  # topics of maps
        listener.every(_LOOK_PERIOD_S, self._look)

    def belong_to(self, frame: str) -> None:
        """Look for a map in the frame of the clouds from now on."""
        is_first, self._frame = self._frame is None, frame
        if is_first:
            self._look()

    def _look(self) -> None:
        endpoints = view.endpoints_on(self._platform)
        publishers = [e for e in endpoints if (e.kind, e.role) == ("publisher", "topic")]
        own = {_node(e) for e in publishers if (e.topic, e.type) == (self._topic, _CLOUD)}
        if self._frame is not None and not self._has_map:
            self._ask_for_map(publishers, own)
        reporting = {_node(e) for e in publishers if (e.topic, e.type) == _DIAGNOSTICS} & own
        if reporting and not self._has_reports:
            self._has_reports = True
            names = {name.rpartition("/")[2] for name in reporting}
            self._listener.also(*_DIAGNOSTICS, partial(self._on_report, names), _ALL_REPORTS)

    def _ask_for_map(self, publishers: Iterable[EndpointInfo], own: set[str]) -> None:
        """Subscribe to one more map; those of the cloud's own node are the last ones."""
        others = [e for e in publishers if e.type == _CLOUD and e.topic != self._topic]
        found = [
            (_node(other) in own, other.topic)
            for other in others
            if other.topic not in self._asked
            and offered_policies(o for o in others if o.topic == other.topic)[1]
        ]
        if found:
            _, topic = min(found)
            self._asked.add(topic)
            self._listener.also(topic, _CLOUD, partial(self._on_map, topic), QosOptions(depth=1))

    def _on_map(self, topic: str, message: Any) -> None:
        if message.header.frame_id != self._frame:
            return
        row = cloud_of(message, MAX_MAP_POINTS)
        if "points" in row:
            self._has_map = True
            self._show({"map": {"topic": topic, **row}})

    def _on_report(self, names: set[str], message: Any) -> None:
        for status in message.status:
            name, _, kind = status.name.partition(": ")
            if kind == _STATUS and name in names:
                self._show({"judgement": judgement_of(status)})


def _node(endpoint: EndpointInfo) -> str:
    return full_node_name(endpoint.node_namespace, endpoint.node_name)
