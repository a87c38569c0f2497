# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""Variants of the mapfiles: with the vehicle, with transfers, with another split."""

from __future__ import annotations

from collections.abc import Sequence
from copy import deepcopy
from pathlib import Path
from typing import Any

import yaml

from rmw_manycore_py.errors import ManycoreError
from rmw_manycore_py.mapfile.format.document import read_yaml
from rmw_manycore_py.mapfile.format.ros_lite import from_list
from rmw_manycore_py.mapfile.installed import find_mapfile
from rmw_manycore_py.native.enums import Transfer

AFTER, BEFORE = "ros_lite.map", "ros_lite_before.yaml"
NODES = "rmw_manycore_py.papers.roslite.nodes"
VEHICLE = "vehicle"
VEHICLE_CLUSTER = 18  # another I/O cluster
LOCALIZER, SEARCH, MERGE, DERIVATIVES = (
    *("lidar_localizer", "radius_search", "radius_merge", "derivatives"),
)
_SEARCH_CLUSTER = 7  # of the first node of radius search; the others follow
_PAIRS = "manycore_ros_lite_msgs/msg/Pairs"
_SUMS = "manycore_ros_lite_msgs/msg/Sums"
# A subscription may read one lane while the next is written.
LANES_AT_ONCE = 2
WAYPOINT_BYTES = 300  # 264, and the ring's own
LANES = ("/lane_waypoints_array", "/traffic_waypoints_array", "/base_waypoints")
PARTS_OF_LANES = ("/safety_waypoints", "/final_waypoints")
PART_BYTES = 128 << 10
LARGER_SMEM = {"profile": "bostan", "smem_size": "4MiB"}  # "If each CC has 4 MB" (ROS-lite IV-A)
LONG_LANE = 2000  # waypoints; longer ones do not fit twice into 2 MiB beside anything else
LIGHT_BYTES = 16 << 10

Variant = dict[str, Any]  # a mapfile's content


def installed(name: str) -> Variant:
    """Return the contents of an installed mapfile, YAML or list."""
    path = find_mapfile(name)
    if path is None:
        raise ManycoreError(f"mapfiles/{name} is not installed")
    document = read_yaml(path)
    if isinstance(document.data, list):
        document = from_list(document)
    return deepcopy(dict(document.data))


def with_vehicle(mapfile: Variant, map_path: Path, **parameters: object) -> Variant:
    """Return the mapfile with the vehicle, and the localizer with its map."""
    variant = deepcopy(mapfile)
    variant["nodes"][LOCALIZER]["parameters"]["map"] = str(map_path)
    variant["nodes"][VEHICLE] = {
        "module": "rmw_manycore_py.papers.roslite.vehicle",
        "cluster": VEHICLE_CLUSTER,
        "core": 1,
        "parameters": parameters,
    }
    return variant


def with_transfer(
    mapfile: Variant, topics: Sequence[str], transfer: Transfer, waypoints: int
) -> Variant:
    """Return the mapfile with another transfer of these topics, and room for lanes."""
    variant = deepcopy(mapfile)
    lane_bytes = LANES_AT_ONCE * WAYPOINT_BYTES * waypoints
    sizes = dict.fromkeys(LANES, lane_bytes) | dict.fromkeys(PARTS_OF_LANES, PART_BYTES)
    variant["topics"] = {topic: {"topic_dsm_size": size} for topic, size in sizes.items()}
    for topic in topics:
        size = sizes.get(topic, LIGHT_BYTES)
        variant["topics"][topic] = {"topic_dsm_size": size, "transfer": transfer}
    if waypoints > LONG_LANE:
        variant["platform"] = LARGER_SMEM
    return variant


def with_split(mapfile: Variant, derivatives: int, searches: int) -> Variant:
    """Return the mapfile with other numbers of clusters.

    :param derivatives: clusters of derivatives.
    :param searches: clusters of radius search, the last of which merges.
    """
    variant = deepcopy(mapfile)
    nodes = variant["nodes"]
    search = next(node for name, node in nodes.items() if name.startswith(SEARCH))
    for name in [name for name in nodes if name.startswith((SEARCH, MERGE, DERIVATIVES))]:
        del nodes[name]
    nodes[LOCALIZER]["parameters"]["derivatives"] = derivatives
    numbers = range(1, derivatives + 1)
    for part in range(searches - 1):
        share = {**search["parameters"], "part": part, "parts": searches - 1}
        place = {"cluster": _SEARCH_CLUSTER + part, "parameters": share}
        nodes[f"{SEARCH}_{part + 1}"] = {**search, **place}
    merge_cluster = _SEARCH_CLUSTER + searches - 1
    nodes[MERGE] = {
        "cluster": merge_cluster,
        "publish": {f"/ndt_pairs_{number}": _PAIRS for number in numbers},
        "subscribe": {"/ndt_found": _PAIRS},
        "module": f"{NODES}.{MERGE}",
        "parameters": {"derivatives": derivatives, "searches": searches - 1},
    }
    for number in numbers:
        nodes[f"{DERIVATIVES}_{number}"] = {
            "cluster": merge_cluster + number,
            "publish": {"/ndt_sums": _SUMS},
            "subscribe": {f"/ndt_pairs_{number}": _PAIRS},
            "module": f"{NODES}.{DERIVATIVES}",
            "parameters": {"number": number},
        }
    return variant


def only_localizer(mapfile: Variant) -> Variant:
    """Return the mapfile without planning and following."""
    variant = deepcopy(mapfile)
    kept = (LOCALIZER, SEARCH, MERGE, DERIVATIVES)
    variant["nodes"] = {
        name: node for name, node in variant["nodes"].items() if name.startswith(kept)
    }
    return variant


def write(mapfile: Variant, path: Path) -> Path:
    """Write the mapfile; return its path."""
    path.write_text(yaml.safe_dump(mapfile, sort_keys=False))
    return path
