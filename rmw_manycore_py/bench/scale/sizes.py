# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""Assumed sizes of messages, for profiles that lack them, by words in the topic's name."""

from __future__ import annotations

from rmw_manycore_py.bench.contenders import MIB

_KIB = 1024
# The first that is in the name counts. Of Autoware's messages: a map of 100,000 points, a scan of
# 65,000 points of 16 bytes, an image of 1440 x 1080 pixels, a grid of 400 x 400 cells, 50 objects.
ASSUMED_BYTES = {
    "pointcloud_map": 2 * MIB,
    "vector_map": 2 * MIB,
    "image": 4 * MIB,
    "pointcloud": MIB,
    "points": MIB,
    "grid": 160 * _KIB,
    "objects": 48 * _KIB,
    "marker": 16 * _KIB,
    "trajectory": 16 * _KIB,
    "path": 16 * _KIB,
    "route": 16 * _KIB,
    "diagnostics": 4 * _KIB,
}
OTHER_BYTES = 256


def assumed_bytes(topic: str) -> int:
    """Return the assumed size of a topic's messages."""
    return next((size for word, size in ASSUMED_BYTES.items() if word in topic), OTHER_BYTES)
