# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""Maps by cells: our map loader serves as Autoware's does, and the matcher requests cells."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from autoware_map_msgs.msg import AreaInfo, PointCloudMapMetaData
from autoware_map_msgs.srv import (
    GetDifferentialPointCloudMap,
    GetPartialPointCloudMap,
    GetSelectedPointCloudMap,
)
from rclpy.node import Node
from rclpy.qos import DurabilityPolicy, QoSProfile

from rmw_manycore_py.ndt.geometry.poses import from_xyz_rpy
from rmw_manycore_py.ndt.maps.map_tiles import open_map, write_tiles
from rmw_manycore_py.ndt.messages.point_cloud import decode
from support import TIMEOUT_S
from support.nodes.ros import spin_until
from support.nodes.scan_matching import (
    NEAR,
    TRUTH,
    error_m,
    matcher_command,
    ros_arguments,
    street_map,
    street_scan,
)
from support.peers.programs import forked_node
from support.processes.program import Program

OK, WARN, ERROR = b"\x00", b"\x01", b"\x02"
DIFFERENTIAL = "service/get_differential_pcd_map"
NARROW = {
    "dynamic_map_loading__map_radius": 30.0,
    "dynamic_map_loading__lidar_radius": 5.0,
}


@pytest.fixture
def tiles(tmp_path: Path) -> Path:
    """Return a folder with the street in tiles of 20 m."""
    write_tiles(tmp_path / "tiles", street_map(), 20.0, ".npz")
    return tmp_path / "tiles"


def loader_command(tiles: Path, *parameters: str, remappings: Sequence[str] = ()) -> list[str]:
    given = [f"pcd_paths_or_directory:=['{tiles}']", "enable_whole_load:=false", *parameters]
    words = ros_arguments(given, remappings)
    return forked_node("rmw_manycore_py.ndt.nodes.pointcloud_map_loader", *words)


def served_as_the_matcher_asks(start: Any, tiles: Path) -> Program:
    """Start a loader whose service has the matcher's default name; it publishes no map."""
    names = (f"{DIFFERENTIAL}:=pcd_loader_service", "pointcloud_map:=unheard")
    return start(loader_command(tiles, remappings=names), cluster=1)


def answered(node: Node, kind: type, name: str, request: Any) -> Any:
    client = node.create_client(kind, name)
    assert client.wait_for_service(TIMEOUT_S)
    answer = client.call_async(request)
    spin_until(node, answer.done)
    return answer.result()


def test_a_loader_serves_cells_as_autoware_s(node, start, tiles):
    start(loader_command(tiles, "enable_selected_load:=true"))
    listed: list[Any] = []
    kept = QoSProfile(depth=1, durability=DurabilityPolicy.TRANSIENT_LOCAL)
    topic = "output/pointcloud_map_metadata"
    node.create_subscription(PointCloudMapMetaData, topic, listed.append, kept)
    area = AreaInfo(center_x=5.0, center_y=0.0, radius=5.0)
    request = GetDifferentialPointCloudMap.Request(area=area)
    all_new = answered(node, GetDifferentialPointCloudMap, DIFFERENTIAL, request)
    expected, points = open_map(tiles).around(5.0, 0.0, 5.0)
    cells = {cell.cell_id: cell for cell in all_new.new_pointcloud_with_ids}
    assert set(cells) == {str(path) for path in expected}
    assert (all_new.header.frame_id, all_new.ids_to_remove) == ("map", [])
    found = np.concatenate([decode(cell.pointcloud) for cell in cells.values()])
    assert len(found) == len(points)
    for cell in cells.values():
        seen, extent = decode(cell.pointcloud), cell.metadata
        assert (seen[:, :2] >= (extent.min_x, extent.min_y)).all()
        assert (seen[:, :2] <= (extent.max_x, extent.max_y)).all()

    held, *lacking = sorted(cells)
    request.cached_ids = [held, "elsewhere.pcd"]
    change = answered(node, GetDifferentialPointCloudMap, DIFFERENTIAL, request)
    assert sorted(cell.cell_id for cell in change.new_pointcloud_with_ids) == lacking
    assert change.ids_to_remove == ["elsewhere.pcd"]

    partial = answered(
        node,
        GetPartialPointCloudMap,
        "service/get_partial_pcd_map",
        GetPartialPointCloudMap.Request(area=area),
    )
    assert {cell.cell_id for cell in partial.new_pointcloud_with_ids} == set(cells)
    selected = answered(
        node,
        GetSelectedPointCloudMap,
        "service/get_selected_pcd_map",
        GetSelectedPointCloudMap.Request(cell_ids=[held, "elsewhere.pcd"]),
    )
    assert [cell.cell_id for cell in selected.new_pointcloud_with_ids] == [held]
    spin_until(node, lambda: listed)
    names = {cell.cell_id for cell in listed[0].metadata_list}
    assert names == {str(tile.path) for tile in open_map(tiles).tiles}


def test_a_matcher_asks_for_the_cells_that_it_lacks(stack, start, tiles):
    """Far away there is no map; back at the place there is one again."""
    start(matcher_command(**NARROW), cluster=2)
    stack.wait_for_matcher()
    assert "pcd_loader_service" in stack.report_of(stack.send(street_scan())).message
    served_as_the_matcher_asks(start, tiles)
    assert error_m(stack.pose_of(street_scan(), NEAR)) < 0.1

    values = {p.key: p.value for p in stack.next_report("map_update_status", OK).values}
    assert values["is_need_rebuild"] == values["is_updated_map"] == "True"
    assert int(values["maps_to_add_size"]) == int(values["maps_size_after"]) > 0

    beside = from_xyz_rpy((30.0, 0.0, 0.0))
    spin_until(stack.node, lambda: cells_removed(stack, beside))
    assert error_m(stack.pose_of(street_scan(), NEAR)) < 0.1


def cells_removed(stack: Any, guess: np.ndarray) -> bool:
    """Return whether a guess elsewhere has removed cells."""
    stack.report_of(stack.send(street_scan(), guess))
    removed = [
        int(pair.value)
        for _, status in stack.reports
        for pair in status.values
        if pair.key == "maps_to_remove_size"
    ]
    return any(removed)


def test_a_loader_that_ends_is_asked_again_when_it_is_back(stack, start, tiles):
    """The map stays until then."""
    start(matcher_command(**NARROW), cluster=2)
    loader = served_as_the_matcher_asks(start, tiles)
    stack.wait_for_matcher()
    assert error_m(stack.pose_of(street_scan(), NEAR)) < 0.1
    loader.stop()
    assert error_m(stack.pose_of(street_scan(), TRUTH)) < 0.1
    served_as_the_matcher_asks(start, tiles)
    spin_until(stack.node, lambda: cells_removed(stack, from_xyz_rpy((30.0, 0.0, 0.0))))
    assert error_m(stack.pose_of(street_scan(), NEAR)) < 0.1
