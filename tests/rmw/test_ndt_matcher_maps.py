# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""Maps of `ndt_scan_matcher`: of all kinds and places, replaced at run time, and refused."""

from __future__ import annotations

import os
from contextlib import suppress

import numpy as np
import pytest
from diagnostic_msgs.msg import DiagnosticStatus
from rclpy.qos import DurabilityPolicy, QoSProfile
from sensor_msgs.msg import PointCloud2

from rmw_manycore_py.native import _transport
from rmw_manycore_py.ndt.geometry.poses import from_xyz_rpy, inverse, transform
from rmw_manycore_py.ndt.maps.map_tiles import open_map, write_tiles
from rmw_manycore_py.ndt.messages.conversions import nanoseconds
from rmw_manycore_py.ndt.messages.point_cloud import decode, encode
from support import IS_MANYCORE
from support.nodes.ros import spin_until
from support.nodes.scan_matching import (
    NEAR,
    TRUTH,
    Stack,
    error_m,
    few,
    matcher_command,
    nan_points,
    own_cluster,
    street_map,
    street_scan,
    two_host_cpus,
    write_boastful_npz,
)

OK, ERROR = b"\x00", b"\x02"
LEFT_BYTES = 64 * 1024  # less than any map needs
UTM = from_xyz_rpy((500_000.0, 5_000_000.0, 100.0))


def again(stack: Stack) -> DiagnosticStatus:
    """Publish the scan, and return the diagnostics of it."""
    return stack.report_of(stack.send(street_scan()))


def test_a_map_of_another_place_and_back(matched):
    """Maps are replaced while scans arrive; a map of another place gives no pose."""
    matched.pose_of(street_scan())
    matched.publish_map(street_map() + np.float32([5000.0, 0.0, 0.0]))
    spin_until(matched.node, lambda: "no convergence" in again(matched).message)
    matched.publish_map(street_map())
    assert error_m(matched.pose_of(street_scan(), NEAR)) < 0.1


def test_a_place_far_from_the_map_s_origin(matched):
    """The pose there is as accurate as at the origin, and so are the published messages."""
    clouds = {}
    keep = lambda cloud: clouds.__setitem__(nanoseconds(cloud.header.stamp), cloud)  # noqa: E731
    matched.node.create_subscription(PointCloud2, "points_aligned", keep, 10)
    matched.publish_map(transform(UTM, street_map().astype(np.float64)))
    matched.begin_anew()
    expected = inverse(UTM) @ matched.pose_of(street_scan(), UTM @ NEAR)
    stamp_ns = max(matched.poses)
    spin_until(matched.node, lambda: stamp_ns in clouds)
    seen = transform(inverse(UTM), decode(clouds[stamp_ns]))
    np.testing.assert_allclose(seen, transform(expected, street_scan()), atol=1e-3)
    matched.publish_map(street_map())
    matched.begin_anew()
    here = matched.pose_of(street_scan(), NEAR)
    assert error_m(here) < 0.1
    np.testing.assert_allclose(expected, here, atol=1e-3)


def test_a_map_that_single_precision_has_spoiled(matched):
    """It is used, and the diagnostics report every second what is wrong with it."""
    matched.publish_map(transform(UTM, street_map().astype(np.float64)).astype(np.float32))
    spin_until(
        matched.node,
        lambda: any("every 0.5 m there: give them as" in s.message for _, s in matched.reports),
    )
    matched.publish_map(street_map())
    assert error_m(matched.pose_of(street_scan(), NEAR)) < 0.1
    matched.reports.clear()
    spin_until(
        matched.node,
        lambda: any(s.name.endswith("map_update_status") for _, s in matched.reports),
    )
    assert not any("coarse" in s.message for _, s in matched.reports)


def test_maps_that_are_none(matched):
    """They are reported, and the previous map stays."""
    matched.pose_of(street_scan())
    for points in (few(0), few(2), nan_points()):
        matched.reports.clear()
        matched.publish_map(points)
        spin_until(
            matched.node,
            lambda: any("map cannot be used" in status.message for _, status in matched.reports),
        )
    assert error_m(matched.pose_of(street_scan(), NEAR)) < 0.1


def test_a_map_of_another_frame_is_refused(matched):
    matched.pose_of(street_scan())
    matched.maps.publish(encode(street_map() + np.float32(9.0), matched.stamp(), "odom"))
    words = "pointcloud_map is in the frame 'odom', expected 'map'"
    spin_until(matched.node, lambda: any(words in s.message for _, s in matched.reports))
    assert error_m(matched.pose_of(street_scan(), NEAR)) < 0.1


@pytest.mark.skipif(not IS_MANYCORE, reason="the SMEM of a cluster is rmw_manycore's")
def test_a_map_that_the_cluster_has_no_room_for(stack, start):
    """The memory that a matcher shares with its workers is part of its cluster's SMEM."""
    program = start(matcher_command(worker_host_cpus=two_host_cpus()), cluster=1)
    stack.wait_for_matcher()
    before = own_cluster()
    assert before.used_bytes > before.charged_bytes > 1 << 20  # the buffer for scans
    for _ in range(2):
        stack.publish_map(street_map())
        stack.pose_of(street_scan(), NEAR)
        program.wait_for("matching to a map of")
    cluster = own_cluster()
    assert cluster.charged_bytes > before.charged_bytes

    platform = os.environ["MANYCORE_PLATFORM"]
    reserve = min(cluster.smem_bytes // 8, 8 << 20)  # only control blocks are allocated there
    charged = 0
    stack.reports.clear()

    def refusals() -> list[DiagnosticStatus]:
        """Leave no room for a map: a map that is being replaced frees its memory later."""
        nonlocal charged
        now = own_cluster()
        free = now.smem_bytes - now.used_bytes - reserve - LEFT_BYTES
        if free > 0:
            with suppress(_transport.PlatformError):  # the matcher has taken it
                _transport.charge_smem(platform, charged + free)
                charged += free
            stack.publish_map(street_map())
        ours = [status for _, status in stack.reports if status.name.endswith("map_update_status")]
        return [status for status in ours if status.level == ERROR]

    spin_until(stack.node, refusals)
    report = refusals()[0]
    assert "cluster 1 has no room for" in report.message
    assert "raise smem_size in the mapfile" in report.message
    assert error_m(stack.pose_of(street_scan(), NEAR)) < 0.1

    _transport.charge_smem(platform, 0)
    stack.publish_map(street_map())
    stack.next_report("map_update_status", OK)


def test_tiles_around_the_vehicle(stack, start, tmp_path):
    """The map comes from files; far away there is none, and back at the place there is one."""
    write_tiles(tmp_path / "tiles", street_map(), 20.0, ".npz")
    more = {
        "dynamic_map_loading__map_radius": 30.0,
        "dynamic_map_loading__lidar_radius": 5.0,
        "dynamic_map_loading__publish_loaded_map": "true",
        "behaviour": "autoware",  # does not recover by itself from a guess far away
    }
    maps = []
    kept = QoSProfile(depth=1, durability=DurabilityPolicy.TRANSIENT_LOCAL)
    stack.node.create_subscription(PointCloud2, "debug/loaded_pointcloud_map", maps.append, kept)
    start(matcher_command(map_path=tmp_path / "tiles", **more), cluster=2)
    stack.wait_for_matcher()
    assert error_m(stack.pose_of(street_scan(), NEAR)) < 0.1
    spin_until(stack.node, lambda: maps)
    expected = open_map(tmp_path / "tiles").around(*TRUTH[:2, 3], 30.0)[1]
    np.testing.assert_array_equal(decode(maps[0]), expected)
    away = from_xyz_rpy((500.0, 0.0, 0.0))
    spin_until(stack.node, lambda: "no" in stack.report_of(stack.send(street_scan(), away)).message)
    assert error_m(stack.pose_of(street_scan(), NEAR)) < 0.1


@pytest.mark.parametrize("damage", ["missing", "cut off", "rubbish", "boastful"])
def test_a_tile_that_is_damaged_while_driving(stack, start, tmp_path, damage):
    """It is reported, the previous map stays, and the node recovers its pose in that map."""
    folder = tmp_path / "tiles"
    beside = street_map() + np.float32([200.0, 0.0, 0.0])
    write_tiles(folder, np.concatenate([street_map(), beside]), 20.0, ".npz")
    more = {"dynamic_map_loading__map_radius": 60.0, "dynamic_map_loading__lidar_radius": 5.0}
    start(matcher_command(map_path=folder, **more), cluster=2)
    stack.wait_for_matcher()
    assert error_m(stack.pose_of(street_scan(), NEAR)) < 0.1
    for path in folder.glob("10_*.npz"):
        whole = bytearray(path.read_bytes())
        if damage == "missing":
            path.unlink()
        elif damage == "cut off":
            path.write_bytes(whole[: len(whole) // 2])
        elif damage == "boastful":
            write_boastful_npz(path)
        else:
            whole[200:240] = bytes(range(40))
            path.write_bytes(whole)
    away = from_xyz_rpy((205.0, 0.0, 0.0))
    spin_until(
        stack.node,
        lambda: (
            stack.report_of(stack.send(street_scan(), away))
            and any("map cannot be used" in status.message for _, status in stack.reports)
        ),
    )
    assert error_m(stack.pose_of(street_scan(), NEAR)) < 0.1


def test_a_standing_vehicle_gets_its_map_once_all_tiles_are_there(stack, start, tmp_path):
    """Its first map, and the next one, whose tiles another process reads."""
    folder, away = tmp_path / "tiles", tmp_path / "away"
    beside = street_map() + np.float32([200.0, 0.0, 0.0])
    write_tiles(folder, np.concatenate([street_map(), beside]), 20.0, ".npz")
    more = {
        "dynamic_map_loading__map_radius": 60.0,
        "dynamic_map_loading__lidar_radius": 5.0,
        "dynamic_map_loading__publish_loaded_map": "true",
    }
    maps = []
    kept = QoSProfile(depth=1, durability=DurabilityPolicy.TRANSIENT_LOCAL)
    stack.node.create_subscription(PointCloud2, "debug/loaded_pointcloud_map", maps.append, kept)
    start(matcher_command(map_path=folder, **more), cluster=2)
    stack.wait_for_matcher()
    for count, (name, x) in enumerate([("0_0.npz", 0.0), ("10_0.npz", 200.0)]):
        there = from_xyz_rpy((x, 0.0, 0.0)) @ NEAR
        (folder / name).rename(away)
        stack.reports.clear()
        spin_until(
            stack.node,
            lambda there=there: (
                stack.report_of(stack.send(street_scan(), there))
                and any("there is no such file" in status.message for _, status in stack.reports)
            ),
        )
        assert len(maps) == count
        away.rename(folder / name)
        spin_until(
            stack.node,
            lambda there=there, count=count: (
                stack.report_of(stack.send(street_scan(), there)) and len(maps) > count
            ),
        )
