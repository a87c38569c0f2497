# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""The nodes around the matcher, each by itself; integration/test_ndt_replay.py has all together."""

from __future__ import annotations

import sys

import numpy as np
import pytest
from geometry_msgs.msg import PoseWithCovarianceStamped
from ndt_support import COVARIANCE, street_map, street_scan
from rclpy.qos import DurabilityPolicy, QoSProfile
from ros_support import spin_until
from sensor_msgs.msg import PointCloud2

from rmw_manycore_py.ndt.map_tiles import write_tiles
from rmw_manycore_py.ndt.nodes.conversions import matrix_of, pose_with_covariance
from rmw_manycore_py.ndt.nodes.point_cloud import decode, encode
from rmw_manycore_py.ndt.poses import distance_m, from_xyz_rpy
from rmw_manycore_py.ndt.thinning import voxel_centroids

KEPT = QoSProfile(depth=1, durability=DurabilityPolicy.TRANSIENT_LOCAL)


def command(module: str, *parameters: str) -> list[str]:
    words = [sys.executable, "-m", f"rmw_manycore_py.ndt.nodes.{module}", "--ros-args"]
    return words + [word for one in parameters for word in ("-p", one)]


def test_the_filter_thins_a_scan(node, start):
    start(command("voxel_grid_filter", "voxel_size_x:=0.5", "voxel_size_y:=0.5"))
    heard = []
    node.create_subscription(PointCloud2, "output", heard.append, 10)
    publisher = node.create_publisher(PointCloud2, "input", 10)
    spin_until(node, lambda: publisher.get_subscription_count() and node.count_publishers("output"))
    broken = PointCloud2(width=5, height=1)
    scan = encode(street_scan(), node.get_clock().now().to_msg(), "lidar")
    spin_until(node, lambda: publisher.publish(broken) or publisher.publish(scan) or heard)
    assert heard[0].header == scan.header
    np.testing.assert_array_equal(decode(heard[0]), voxel_centroids(street_scan(), (0.5, 0.5, 0.1)))


def test_the_loader_publishes_what_is_near_the_vehicle(node, start, tmp_path):
    write_tiles(tmp_path / "tiles", street_map(), 20.0, ".npz")
    folder = f"pcd_paths_or_directory:={tmp_path / 'tiles'}"
    start(command("pointcloud_map_loader", folder, "enable_whole_load:=false", "map_radius:=5"))
    heard = []
    node.create_subscription(PointCloud2, "pointcloud_map", heard.append, KEPT)
    poses = node.create_publisher(PoseWithCovarianceStamped, "ekf_pose_with_covariance", 1)
    spin_until(node, poses.get_subscription_count)
    for x in (-30.0, 10.0):
        place = pose_with_covariance(
            from_xyz_rpy((x, 0.0, 0.0)), COVARIANCE, node.get_clock().now().to_msg(), "map"
        )
        heard.clear()
        spin_until(node, lambda place=place: poses.publish(place) or heard)
        points = decode(heard[0])
        assert len(points) < len(street_map())
        assert np.abs(points[:, 0] - x).max() < 40.0


@pytest.mark.parametrize("path", ["''", "/nonexistent"])
def test_the_loader_needs_a_map(start, path):
    program = start(command("pointcloud_map_loader", f"pcd_paths_or_directory:={path}"))
    assert program.wait() == 2
    assert "Traceback" not in program.output


def test_the_ekf_follows_and_passes_over_what_is_none(node, start):
    start(command("ekf_localizer", "predict_frequency:=100.0"))
    heard = []
    pose = PoseWithCovarianceStamped
    node.create_subscription(pose, "ekf_pose_with_covariance", heard.append, 10)
    measured = node.create_publisher(pose, "in_pose_with_covariance", 10)
    spin_until(node, measured.get_subscription_count)
    truth = from_xyz_rpy((3.0, -2.0, 1.0), (0.0, 0.0, 0.5))

    def publish(**position: float) -> bool:
        stamp = node.get_clock().now().to_msg()
        message = pose_with_covariance(truth, COVARIANCE, stamp, "map")
        for axis, value in position.items():
            setattr(message.pose.pose.position, axis, value)
        measured.publish(message)
        return False

    spin_until(node, lambda: publish() or publish(x=float("nan")) or len(heard) > 50)
    for message in heard:
        T = matrix_of(message.pose.pose)
        assert distance_m(T, truth) < 0.1
        assert np.isfinite(message.pose.covariance).all()
