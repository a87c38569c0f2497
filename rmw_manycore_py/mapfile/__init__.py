# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""The mapfile: which node runs on which core of which cluster, and how it is started."""

from rmw_manycore_py.mapfile.loader import Mapfile, load_mapfile
from rmw_manycore_py.mapfile.placement import (
    BridgePlacement,
    ClusterMemory,
    PlacedNode,
    Placement,
    TopicEntry,
)
from rmw_manycore_py.mapfile.resolve import resolve

__all__ = [
    "BridgePlacement",
    "ClusterMemory",
    "Mapfile",
    "PlacedNode",
    "Placement",
    "TopicEntry",
    "load_mapfile",
    "resolve",
]
