# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""The mapfile: which node runs on which core of which cluster, and how it is started."""

from __future__ import annotations

from pathlib import Path

from rmw_manycore_py.mapfile.format.loader import load_mapfile
from rmw_manycore_py.mapfile.format.mapfile import Mapfile
from rmw_manycore_py.mapfile.placing.placement import (
    BridgePlacement,
    ClusterMemory,
    PlacedNode,
    Placement,
    TopicEntry,
)
from rmw_manycore_py.mapfile.placing.resolve import resolve
from rmw_manycore_py.mapfile.placing.show import as_data
from rmw_manycore_py.mapfile.template import init

__all__ = [
    "BridgePlacement",
    "ClusterMemory",
    "Mapfile",
    "PlacedNode",
    "Placement",
    "TopicEntry",
    "as_data",
    "check",
    "init",
    "load_mapfile",
    "resolve",
]


def check(path: Path | str) -> Placement:
    """Read a mapfile and resolve everything it refers to; raise MapfileError for all problems.

    Nodes of a plan need not be installed.
    """
    return resolve(load_mapfile(path), to_start=False)
