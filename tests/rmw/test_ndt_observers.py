# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""`ndt_scan_matcher` with observers: what they subscribe to must not disturb the matching."""

from __future__ import annotations

import os

import numpy as np
import pytest
from rclpy.qos import DurabilityPolicy, QoSProfile
from sensor_msgs.msg import PointCloud2

from rmw_manycore_py.native import _transport
from rmw_manycore_py.ndt.geometry.poses import from_xyz_rpy
from rmw_manycore_py.ndt.maps.map_file import write_points
from rmw_manycore_py.ndt.maps.map_tiles import open_map, write_tiles
from rmw_manycore_py.ndt.messages.point_cloud import decode
from support import IS_MANYCORE
from support.nodes.ros import spin_until
from support.nodes.scan_matching import (
    NEAR,
    TRUTH,
    error_m,
    matcher_command,
    own_cluster,
    street_map,
    street_scan,
)

pytestmark = pytest.mark.rmw
LEFT_BYTES = 32 * 1024  # less than a cloud


def leave_little_room(platform: str, left_bytes: int = LEFT_BYTES) -> None:
    """Charge all of cluster 1's SMEM but less than a cloud."""
    now = own_cluster()
    reserve = min(now.smem_bytes // 8, 8 << 20)  # only control blocks are allocated there
    _transport.charge_smem(platform, now.smem_bytes - now.used_bytes - reserve - left_bytes)


@pytest.mark.skipif(not IS_MANYCORE, reason="the SMEM of a cluster is rmw_manycore's")
def test_clouds_without_room_are_missing_but_not_the_poses(stack, start):
    program = start(matcher_command(), cluster=1)
    stack.wait_for_matcher()
    stack.publish_map(street_map())
    stack.pose_of(street_scan(), NEAR)
    platform = os.environ["MANYCORE_PLATFORM"]
    leave_little_room(platform)

    clouds = []
    stack.node.create_subscription(PointCloud2, "points_aligned", clouds.append, 10)
    for _ in range(3):
        assert error_m(stack.pose_of(street_scan(), NEAR)) < 0.1
    program.wait_for("points_aligned is not published: .* cluster 1 has no room for")
    assert clouds == []

    _transport.charge_smem(platform, 0)
    assert error_m(stack.pose_of(street_scan(), NEAR)) < 0.1
    spin_until(stack.node, lambda: clouds)


def test_an_observer_sees_the_tiles_of_the_map(stack, start, tmp_path):
    """Subscribed after the map was loaded, and again after the vehicle needed other tiles."""
    beside = street_map() + np.float32([200.0, 0.0, 0.0])
    write_tiles(tmp_path / "tiles", np.concatenate([street_map(), beside]), 20.0, ".npz")
    more = {"dynamic_map_loading__map_radius": 60.0, "dynamic_map_loading__lidar_radius": 5.0}
    start(matcher_command(map_path=tmp_path / "tiles", **more), cluster=2)
    stack.wait_for_matcher()
    assert error_m(stack.pose_of(street_scan(), NEAR)) < 0.1

    maps = []
    kept = QoSProfile(depth=1, durability=DurabilityPolicy.TRANSIENT_LOCAL)
    stack.node.create_subscription(PointCloud2, "debug/loaded_pointcloud_map", maps.append, kept)
    spin_until(stack.node, lambda: maps)
    tiles = open_map(tmp_path / "tiles")
    np.testing.assert_array_equal(decode(maps[0]), tiles.around(*TRUTH[:2, 3], 60.0)[1])

    there = from_xyz_rpy((200.0, 0.0, 0.0))
    expected = tiles.around(*there[:2, 3], 60.0)[1]
    spin_until(stack.node, lambda: stack.send(street_scan(), there) and len(maps) > 1)
    np.testing.assert_array_equal(decode(maps[1]), expected)


@pytest.mark.skipif(not IS_MANYCORE, reason="the SMEM of a cluster is rmw_manycore's")
def test_a_map_without_room_is_published_once_there_is_room(stack, start, tmp_path):
    write_tiles(tmp_path / "tiles", street_map(), 20.0, ".npz")
    program = start(matcher_command(map_path=tmp_path / "tiles"), cluster=1)
    stack.wait_for_matcher()
    stack.pose_of(street_scan(), NEAR)
    platform = os.environ["MANYCORE_PLATFORM"]
    leave_little_room(platform)
    maps = []
    kept = QoSProfile(depth=1, durability=DurabilityPolicy.TRANSIENT_LOCAL)
    stack.node.create_subscription(PointCloud2, "debug/loaded_pointcloud_map", maps.append, kept)
    program.wait_for("debug/loaded_pointcloud_map is not published: .* has no room for")
    _transport.charge_smem(platform, 0)
    spin_until(stack.node, lambda: maps)


@pytest.mark.skipif(not IS_MANYCORE, reason="the SMEM of a cluster is rmw_manycore's")
def test_a_whole_map_without_room_is_published_once_there_is_room(stack, start, tmp_path):
    """Its voxels have room from the start, its many points have not."""
    points = np.repeat(street_map(), 50, axis=0)
    write_points(tmp_path / "map.npz", points)
    platform = os.environ["MANYCORE_PLATFORM"]
    leave_little_room(platform, left_bytes=points.nbytes // 2)
    whole = {"dynamic_map_loading__publish_loaded_map": "true"}
    program = start(matcher_command(map_path=tmp_path / "map.npz", **whole), cluster=1)
    stack.wait_for_matcher()
    stack.pose_of(street_scan(), NEAR)
    program.wait_for("debug/loaded_pointcloud_map is not published: .* has no room for")
    maps = []
    kept = QoSProfile(depth=1, durability=DurabilityPolicy.TRANSIENT_LOCAL)
    stack.node.create_subscription(PointCloud2, "debug/loaded_pointcloud_map", maps.append, kept)
    _transport.charge_smem(platform, 0)
    spin_until(stack.node, lambda: maps)
    assert len(decode(maps[0])) == len(points)
