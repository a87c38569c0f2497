# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""Clouds and judgements of them as the page of `manycore view` shows them."""

from __future__ import annotations

from base64 import b64encode
from typing import Any

import numpy as np

from rmw_manycore_py.cli.common.message_text import shortened

Row = dict[str, Any]

MAX_POINTS = 20_000
MAX_MAP_POINTS = 100_000
MAX_TEXT = 300  # characters of a text from a message; the viewer reads lines of limited length
# Needed fields of a PointCloud2, and of other messages like it.
_FIELDS = {
    "header": "std_msgs/Header",
    "fields": "sequence<sensor_msgs/PointField>",
    "is_bigendian": "boolean",
    **dict.fromkeys(("height", "width", "point_step", "row_step"), "uint32"),
    "data": "sequence<uint8>",
}


def is_cloud(message_type: Any) -> bool:
    """Return whether messages of a type are clouds."""
    return bool(_FIELDS.items() <= message_type.get_fields_and_field_types().items())


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
