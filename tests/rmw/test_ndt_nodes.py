# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""The nodes around the matcher, each alone; integration/test_ndt_replay.py has all together."""

from __future__ import annotations

import signal
import sys
from collections.abc import Callable

import numpy as np
import pytest
from geometry_msgs.msg import PoseWithCovarianceStamped
from rclpy.qos import DurabilityPolicy, QoSProfile
from sensor_msgs.msg import PointCloud2

from rmw_manycore_py.ndt.geometry.poses import from_xyz_rpy
from rmw_manycore_py.ndt.geometry.thinning import voxel_centroids
from rmw_manycore_py.ndt.maps.map_file import write_points
from rmw_manycore_py.ndt.maps.map_tiles import write_tiles
from rmw_manycore_py.ndt.messages.conversions import matrix_of, pose_with_covariance
from rmw_manycore_py.ndt.messages.point_cloud import decode, encode
from rmw_manycore_py.ndt.messages.point_times import decode_timed, time_field
from support.nodes.ros import spin_until
from support.nodes.scan_matching import (
    COVARIANCE,
    TRUTH,
    Stack,
    command,
    error_m,
    matcher_command,
    ros_arguments,
    street_map,
    street_scan,
    write_boastful_npz,
)
from support.peers.programs import forked_node
from support.processes.program import Program

INITIALIZER = "rmw_manycore_py.ndt.nodes.pose_initializer"
KEPT = QoSProfile(depth=1, durability=DurabilityPolicy.TRANSIENT_LOCAL)


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

    times_s = np.linspace(0.0, 0.1, len(street_scan()))
    timed = encode(street_scan(), scan.header.stamp, "lidar", {"time": times_s})
    spin_until(node, lambda: publisher.publish(timed) or time_field(heard[-1]))
    points, thinned_s = decode_timed(heard[-1], "time")
    means = voxel_centroids(np.column_stack((street_scan(), times_s)), (0.5, 0.5, 0.1))
    np.testing.assert_allclose(points, means[:, :3], atol=1e-5)
    np.testing.assert_allclose(thinned_s, means[:, 3], atol=1e-8)

    slow = encode(street_scan(), scan.header.stamp, "lidar", {"time": 60 * times_s})
    spin_until(node, lambda: publisher.publish(slow) or time_field(heard[-1]) is None)


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


@pytest.mark.parametrize("kind", [np.float64, np.float32])
def test_the_loader_far_from_the_map_s_origin(node, start, tmp_path, kind):
    """Doubles are published unchanged; for single precision a warning states the loss."""
    points = (street_map() + np.array([500_000.0, 5_000_000.0, 100.0])).astype(kind)
    write_points(tmp_path / "map.npz", points)
    loader = start(command("pointcloud_map_loader", f"pcd_paths_or_directory:={tmp_path}/map.npz"))
    heard = []
    node.create_subscription(PointCloud2, "pointcloud_map", heard.append, KEPT)
    spin_until(node, lambda: heard)
    np.testing.assert_array_equal(decode(heard[0]), points)
    loader.wait_for("publishing a map of")
    assert ("the map is coarse: " in loader.output) == (kind is np.float32)


def test_the_loader_goes_on_with_a_tile_that_is_damaged(node, start, tmp_path):
    write_tiles(tmp_path / "tiles", street_map(), 20.0, ".npz")
    write_boastful_npz(tmp_path / "tiles" / "0_0.npz")
    folder = f"pcd_paths_or_directory:={tmp_path / 'tiles'}"
    loader = start(
        command("pointcloud_map_loader", folder, "enable_whole_load:=false", "map_radius:=1")
    )
    heard = []
    node.create_subscription(PointCloud2, "pointcloud_map", heard.append, KEPT)
    poses = node.create_publisher(PoseWithCovarianceStamped, "ekf_pose_with_covariance", 1)
    spin_until(node, poses.get_subscription_count)
    for x in (5.0, -30.0):
        place = pose_with_covariance(
            from_xyz_rpy((x, 5.0, 0.0)), COVARIANCE, node.get_clock().now().to_msg(), "map"
        )
        poses.publish(place)
        if x > 0.0:
            loader.wait_for(r"0_0\.npz: .*cannot be read as npz: it announces more data")
    spin_until(node, lambda: heard)
    assert decode(heard[0])[:, 0].max() < -20.0


@pytest.mark.parametrize("path", ["''", "/nonexistent"])
def test_the_loader_needs_a_map(start, path):
    program = start(command("pointcloud_map_loader", f"pcd_paths_or_directory:={path}"))
    assert program.wait() == 2
    assert "Traceback" not in program.output


@pytest.fixture
def unmatched(node, start) -> Stack:
    """Return a stack whose matcher has map and scan, and waits to be activated."""
    start(matcher_command(activated="false"), cluster=2)
    stack = Stack(node)
    stack.wait_for_matcher()
    stack.publish_map(street_map())
    return stack


def initializer(*parameters: str) -> list[str]:
    """Return the command of an initializer that uses the matcher alone."""
    return forked_node(INITIALIZER, *initializer_arguments(*parameters))


def initializer_arguments(*parameters: str) -> list[str]:
    names = ("ndt_align:=ndt_align_srv", "ndt_trigger_node:=trigger_node_srv")
    return ros_arguments(["ekf_enabled:=false", *parameters], names)


def first_pose(stack: Stack, also: Callable[[], object] = lambda: None) -> np.ndarray:
    """Publish scans until the initializer has found a pose, and return it."""
    found = []
    stack.node.create_subscription(PoseWithCovarianceStamped, "initialpose3d", found.append, KEPT)
    spin_until(stack.node, lambda: (stack.send(street_scan(), None) and also()) or found)
    return matrix_of(found[0].pose.pose)


def rough(stack: Stack, T: np.ndarray, age_s: int = 0) -> PoseWithCovarianceStamped:
    """Return a pose half a metre off, without a covariance: the initializer sets it."""
    T = from_xyz_rpy((0.4, -0.3, 0.0)) @ T
    stamp = stack.node.get_clock().now().to_msg()
    stamp.sec -= age_s
    return pose_with_covariance(T, np.zeros((6, 6)), stamp, "map")


def test_a_first_pose_by_hand(unmatched, start):
    """As RViz and `topic pub` publish it."""
    start(initializer())
    publisher = unmatched.node.create_publisher(PoseWithCovarianceStamped, "initialpose", 1)
    spin_until(unmatched.node, publisher.get_subscription_count)
    publisher.publish(rough(unmatched, TRUTH))
    assert error_m(first_pose(unmatched)) < 0.1


def want_a_pose_of(program: Program, stack: Stack) -> None:
    """Publish a rough pose until the initializer has called the matcher."""
    publisher = stack.node.create_publisher(PoseWithCovarianceStamped, "initialpose", 1)
    spin_until(stack.node, publisher.get_subscription_count)
    for _ in range(2):  # when it has received the second one, it has handled the first
        publisher.publish(rough(stack, TRUTH))
        program.wait_for("]: INITIALIZING")


def test_a_first_pose_though_the_matcher_was_killed_over_it(stack, start):
    matcher = start(matcher_command(), cluster=2)
    stack.wait_for_matcher()
    program = start(initializer())
    program.wait_for("]: UNINITIALIZED")
    matcher.signal(signal.SIGSTOP)
    want_a_pose_of(program, stack)
    matcher.signal(signal.SIGKILL)
    program.wait_for("ndt_align does not answer")
    start(matcher_command(), cluster=2)
    stack.publish_map(street_map())
    assert error_m(first_pose(stack)) < 0.1


def test_a_first_pose_though_the_matcher_was_stopped_over_it(stack, start):
    """It is called again, and its late response to the first call is ignored.

    It has to answer later calls in time, so it tries few poses.
    """
    few_poses = {
        "initial_pose_estimation__particles_num": 10,
        "initial_pose_estimation__n_startup_trials": 10,
    }
    matcher = start(matcher_command(**few_poses), cluster=2)
    stack.wait_for_matcher()
    stack.publish_map(street_map())
    hasty = f"import {INITIALIZER} as node; node.ANSWER_TIMEOUT_S = 5.0; node.main()"
    program = start([sys.executable, "-c", hasty, *initializer_arguments()])
    program.wait_for("]: UNINITIALIZED")
    matcher.signal(signal.SIGSTOP)
    want_a_pose_of(program, stack)
    program.wait_for("ndt_align does not answer")
    matcher.signal(signal.SIGCONT)
    assert error_m(first_pose(stack)) < 0.1


def test_a_first_pose_of_the_parameters(unmatched, start):
    x, y, z = TRUTH[:3, 3]
    pose = f"user_defined_initial_pose.pose:=[{x + 0.4}, {y - 0.3}, {z}, 0.0, 0.0, 0.0, 1.0]"
    start(initializer("user_defined_initial_pose.enable:=true", pose))
    assert error_m(first_pose(unmatched)) < 0.1


def test_a_first_pose_without_any_guess(unmatched, start):
    start(initializer("search_map:=true"))
    assert error_m(first_pose(unmatched)) < 0.1


def test_a_first_pose_of_gnss(unmatched, start):
    """It contains no direction; old positions are skipped, and later ones change nothing."""
    program = start(initializer("gnss_enabled:=true"))
    publisher = unmatched.node.create_publisher(PoseWithCovarianceStamped, "gnss_pose_cov", 1)
    position = from_xyz_rpy(TRUTH[:3, 3])

    def publish(age_s: int) -> None:
        publisher.publish(rough(unmatched, position, age_s))

    spin_until(unmatched.node, lambda: publish(100) or "100.0 s old" in program.output)
    assert "]: INITIALIZING" not in program.output
    assert error_m(first_pose(unmatched, lambda: publish(0))) < 0.1
    program.wait_for("]: INITIALIZED")
    publish(0)
    by_hand = unmatched.node.create_publisher(PoseWithCovarianceStamped, "initialpose", 1)
    spin_until(unmatched.node, by_hand.get_subscription_count)
    by_hand.publish(rough(unmatched, TRUTH))
    program.wait_for("]: INITIALIZED")
    assert program.output.count("]: INITIALIZING") == 2
