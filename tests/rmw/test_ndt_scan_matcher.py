# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""The node `ndt_scan_matcher`: its topics, its services, and bad input of all kinds."""

from __future__ import annotations

import os
import signal
from array import array
from typing import Any

import numpy as np
import pytest
from autoware_internal_debug_msgs.msg import Float32Stamped, Int32Stamped
from autoware_internal_localization_msgs.srv import PoseWithCovarianceStamped as AlignService
from diagnostic_msgs.msg import DiagnosticStatus
from geometry_msgs.msg import PoseArray, PoseWithCovarianceStamped, TransformStamped
from numpy.typing import NDArray
from rclpy.qos import DurabilityPolicy, QoSProfile
from sensor_msgs.msg import PointCloud2
from tf2_msgs.msg import TFMessage
from visualization_msgs.msg import MarkerArray

from rmw_manycore_py.ndt.geometry.poses import from_xyz_rpy, inverse, transform
from rmw_manycore_py.ndt.messages.conversions import (
    matrix_of,
    matrix_of_transform,
    nanoseconds,
    pose_with_covariance,
    transform_stamped,
)
from rmw_manycore_py.ndt.messages.point_cloud import decode, encode
from support.nodes.ros import spin_until
from support.nodes.scan_matching import (
    COVARIANCE,
    NEAR,
    TRUTH,
    error_m,
    few,
    killed_as_they_come,
    matcher_command,
    nan_points,
    street_map,
    street_scan,
    two_host_cpus,
    workers_below,
)

OK, WARN, ERROR = b"\x00", b"\x01", b"\x02"


def test_a_pose_and_all_that_belongs_to_it(matched):
    heard = {}

    def listen(kind: type, topic: str) -> None:
        keep = lambda message: heard.__setitem__(topic, message)  # noqa: E731
        matched.node.create_subscription(kind, topic, keep, 10)

    floats = [
        "exe_time_ms",
        "transform_probability",
        "nearest_voxel_transformation_likelihood",
        "initial_to_result_distance",
    ]
    for topic in floats:
        listen(Float32Stamped, topic)
    listen(Int32Stamped, "iteration_num")
    listen(PoseWithCovarianceStamped, "ndt_pose_with_covariance")
    listen(PointCloud2, "points_aligned")
    listen(TFMessage, "/tf")
    listen(MarkerArray, "ndt_marker")
    matched.be_sure()
    listen(PointCloud2, "voxel_score_points")
    count = len(floats) + 6
    while len(heard) < count:
        matched.pose_of(street_scan(), NEAR)
    heard.clear()
    matched.pose_of(street_scan(), NEAR)
    stamp_ns, T = max(matched.poses.items())
    spin_until(
        matched.node,
        lambda: (
            len(heard) == count and {stamp_of(message) for message in heard.values()} == {stamp_ns}
        ),
    )

    assert error_m(T) < 0.1
    with_covariance = heard["ndt_pose_with_covariance"]
    np.testing.assert_array_equal(matrix_of(with_covariance.pose.pose), T)
    assert with_covariance.pose.covariance[0] == pytest.approx(0.0225, rel=0.01)
    transformed = heard["/tf"].transforms[0]
    assert (transformed.header.frame_id, transformed.child_frame_id) == ("map", "ndt_base_link")
    np.testing.assert_allclose(matrix_of_transform(transformed.transform), T, atol=1e-9)
    expected = transform(T, street_scan())
    np.testing.assert_allclose(decode(heard["points_aligned"]), expected, atol=1e-3)
    assert heard["initial_to_result_distance"].data == pytest.approx(0.3, abs=0.1)
    assert heard["iteration_num"].data > 0
    scored = heard["voxel_score_points"]
    assert [field.name for field in scored.fields] == ["x", "y", "z", "rgb"]
    assert 0.8 * len(expected) < scored.width <= len(expected)
    check_gain(matched.report_of(stamp_ns))
    _, guess, *_, result = heard["ndt_marker"].markers
    assert len(heard["ndt_marker"].markers) == 2 + heard["iteration_num"].data
    assert error_m(matrix_of(guess.pose)) == pytest.approx(0.3, abs=0.01)
    np.testing.assert_allclose(matrix_of(result.pose), T, atol=1e-9)


def check_gain(report: DiagnosticStatus) -> None:
    """Check that the scores in the diagnostics before, after and in between are consistent."""
    values = {pair.key: pair.value for pair in report.values}
    for name in ("transform_probability", "nearest_voxel_transformation_likelihood"):
        gain = float(values[name]) - float(values[f"{name}_before"])
        assert float(values[f"{name}_diff"]) == pytest.approx(gain)
        assert gain > 0.0


MADE_OF = {1: (), 2: ("multi_initial_pose", "multi_ndt_pose"), 3: ("multi_initial_pose",)}


def stamp_of(message: Any) -> int:
    """Return the stamp [ns] of a message, or of the first one inside."""
    for name in ("transforms", "markers"):
        message = getattr(message, name, [message])[0]
    return nanoseconds(message.header.stamp if hasattr(message, "header") else message.stamp)


@pytest.mark.parametrize("kind", [1, 2, 3], ids=["laplace", "multi_ndt", "multi_ndt_score"])
def test_the_covariance_may_be_estimated(stack, start, kind):
    fixed = ", ".join("1.0e-9" if i % 7 == 0 else "0.0" for i in range(36))
    parameters = {
        "covariance__covariance_estimation__covariance_estimation_type": kind,
        "covariance__output_pose_covariance": f"[{fixed}]",
    }
    start(matcher_command(**parameters), cluster=2)
    heard = []
    stack.node.create_subscription(
        PoseWithCovarianceStamped, "ndt_pose_with_covariance", heard.append, 10
    )
    several = {"multi_initial_pose": [], "multi_ndt_pose": []}
    for topic, arrays in several.items():
        stack.node.create_subscription(PoseArray, topic, arrays.append, 10)
    stack.wait_for_matcher()
    stack.publish_map(street_map())
    stack.be_sure()
    heard.clear()
    while not heard or not all(several[topic] for topic in MADE_OF[kind]):
        stack.pose_of(street_scan(), NEAR)
    for topic, arrays in several.items():
        assert bool(arrays) == (topic in MADE_OF[kind])
        assert all(error_m(matrix_of(pose)) < 1.2 for message in arrays for pose in message.poses)
        assert {len(message.poses) for message in arrays} <= {6}
    covariance = np.reshape(heard[-1].pose.covariance, (6, 6))
    assert (np.linalg.eigvalsh(covariance[:2, :2]) > 0).all()
    assert 1e-8 < np.trace(covariance[:2, :2]) < 0.25
    assert covariance[2, 2] == pytest.approx(1e-9)


def cut_off() -> PointCloud2:
    message = encode(street_scan(), TransformStamped().header.stamp, "base_link")
    message.data = array("B", bytes(10))
    return message


def in_frame(name: str) -> PointCloud2:
    return encode(street_scan(), TransformStamped().header.stamp, name)


def guess_with(value: float) -> PoseWithCovarianceStamped:
    message = pose_with_covariance(TRUTH, COVARIANCE, TransformStamped().header.stamp, "map")
    message.pose.pose.position.x = value
    return message


def without_orientation() -> PoseWithCovarianceStamped:
    message = guess_with(0.0)
    message.pose.pose.orientation.w = message.pose.pose.orientation.z = 0.0
    message.pose.pose.orientation.x = message.pose.pose.orientation.y = 0.0
    return message


def beyond_the_map() -> NDArray[np.float32]:
    """Return a scan of the street that for the most part sees farther than the map."""
    seen, up_m = street_scan(), np.float32([0, 0, 60])
    return np.concatenate([seen, *(seen + times * up_m for times in (1, 2, 3))])


BAD_SCANS = {
    "empty": (few(0), "no point that is finite"),
    "all NaN": (nan_points(), "no point that is finite"),
    "tiny": (few(3), "no convergence: too few points"),
    "too near": (street_scan() * np.float32(0.01), "required_distance"),
    "cut off": (cut_off(), "bytes of data, found 10"),
    "unknown frame": (in_frame("lidar"), "Please publish TF lidar to base_link"),
    "no frame": (in_frame(""), "Please set its frame_id"),
    "beyond the map": (beyond_the_map(), "% of the points"),
}
BAD_GUESSES = {
    "NaN": guess_with(float("nan")),
    "infinite": guess_with(float("inf")),
    "too far for a number": guess_with(1e30),
    "no orientation": without_orientation(),
}


def test_bad_scans_give_a_diagnostic_and_no_pose(matched):
    matched.pose_of(street_scan())
    for name, (scan, words) in BAD_SCANS.items():
        report = matched.report_of(stamp_ns := matched.send(scan))
        assert report.level == WARN, name
        assert words in report.message, name
        assert stamp_ns not in matched.poses, name
        assert error_m(matched.pose_of(street_scan(), NEAR)) < 0.1, name


def test_bad_guesses_give_a_diagnostic_and_no_pose(matched):
    matched.pose_of(street_scan())
    for name, guess in BAD_GUESSES.items():
        stamp_ns = matched.send(few(0), guess)
        report = matched.report_of(stamp_ns, "initial_pose_subscriber_status")
        assert report.level == ERROR, name
        assert "pose ignored" in report.message, name
        assert error_m(matched.pose_of(street_scan(), NEAR)) < 0.1, name
    in_wrong_frame = guess_with(5.0)
    in_wrong_frame.header.frame_id = "odom"
    stamp_ns = matched.send(few(0), in_wrong_frame)
    report = matched.report_of(stamp_ns, "initial_pose_subscriber_status")
    assert "'odom', expected 'map'" in report.message
    assert all(np.isfinite(T).all() for T in matched.poses.values())


def test_workers_that_are_killed_are_replaced(stack, start):
    """Killed between scans and during one: poses continue, with new workers."""
    program = start(matcher_command(worker_host_cpus=two_host_cpus()), cluster=2)
    stack.wait_for_matcher()
    stack.publish_map(street_map())
    stack.pose_of(street_scan())
    before = workers_below(program.pid)
    assert len(before) == 2
    for pid in before:
        os.kill(pid, signal.SIGKILL)
    assert error_m(stack.pose_of(street_scan(), NEAR)) < 0.1
    after = workers_below(program.pid)
    assert len(after) == 2
    assert not set(before) & set(after)
    stamps_ns = [stack.send(street_scan(), NEAR) for _ in range(3)]
    os.kill(after[0], signal.SIGKILL)
    spin_until(stack.node, lambda: stamps_ns[-1] in stack.poses)
    assert all(error_m(T) < 0.1 for T in stack.poses.values())


def test_workers_that_die_again_and_again(stack, start):
    """Scans, maps and poses are retried until refused: on a busy machine some workers survive."""
    program = start(matcher_command(worker_host_cpus=two_host_cpus()), cluster=2)
    points, scan = street_map(), street_scan()
    stack.wait_for_matcher()
    stack.publish_map(points)
    stack.pose_of(scan)
    words = "the workers ended 5 times in one alignment"
    align = stack.node.create_client(AlignService, "ndt_align_srv")
    rough = pose_with_covariance(NEAR, COVARIANCE, stack.stamp(), "map")
    request = AlignService.Request(pose_with_covariance=rough)

    def refuses_a_scan() -> bool:
        return words in stack.report_of(stack.send(scan)).message

    def refuses_to_align() -> bool:
        answer = align.call_async(request)
        spin_until(stack.node, answer.done)
        return not answer.result().success

    def refuses_a_map() -> bool:
        stack.publish_map(points)
        stack.report_of(stack.send(scan))
        name = "map_update_status"
        return any(words in s.message for _, s in stack.reports if s.name.endswith(name))

    with killed_as_they_come(program.pid):
        for refuses in (refuses_a_scan, refuses_to_align, refuses_a_map):
            spin_until(stack.node, refuses)
    assert error_m(stack.pose_of(scan, NEAR)) < 0.1
    assert "Traceback" not in program.output


def test_a_scan_of_two_million_points(matched):
    scan = np.tile(street_scan(), (2_000_000 // len(street_scan()) + 1, 1))
    matched.pose_of(street_scan())
    stamp_ns = matched.send(scan)
    report = matched.report_of(stamp_ns)
    assert "more than sensor_points.limit" in report.message
    assert {pair.key: pair.value for pair in report.values}["sensor_points_matched"] == "30000"
    spin_until(matched.node, lambda: stamp_ns in matched.poses)
    assert error_m(matched.poses[stamp_ns]) < 0.1


def test_regularization_poses_that_are_none(stack, start):
    """A pose that is not finite is skipped, one elsewhere not used, and a valid one is."""
    program = start(matcher_command(ndt__regularization__enable="true"), cluster=2)
    stack.wait_for_matcher()
    stack.publish_map(street_map())
    stack.pose_of(street_scan())
    topic = "regularization_pose_with_covariance"
    publisher = stack.node.create_publisher(PoseWithCovarianceStamped, topic, 10)
    spin_until(stack.node, publisher.get_subscription_count)

    def send(x: float) -> DiagnosticStatus:
        message = guess_with(x)
        message.header.stamp = stack.stamp()
        publisher.publish(message)
        stamp_ns = nanoseconds(message.header.stamp)
        return stack.report_of(stamp_ns, "regularization_pose_subscriber_status")

    for value in (float("nan"), float("inf"), 1e300):
        report = send(value)
        assert (report.level, "pose ignored" in report.message) == (ERROR, True)
    for _ in range(2):
        assert send(1e4).level == b"\x00"
    stamp_ns = stack.send(street_scan(), NEAR)
    assert "m from the guess: not used" in stack.report_of(stamp_ns).message
    spin_until(stack.node, lambda: stamp_ns in stack.poses)
    assert error_m(stack.poses[stamp_ns]) < 0.1
    for _ in range(2):
        assert send(TRUTH[0, 3]).level == b"\x00"
    assert error_m(stack.pose_of(street_scan(), NEAR)) < 0.1
    program.wait_for("pose ignored")
    program.wait_for("not used")


def test_clocks_that_differ(matched):
    """Scan and guess stamped ahead belong together: they are matched, with a warning."""
    matched.pose_of(street_scan())
    ahead = matched.stamp()
    ahead.sec += 1000
    for _ in range(2):
        matched.guesses.publish(pose_with_covariance(NEAR, COVARIANCE, ahead, "map"))
    report = matched.report_of(nanoseconds(ahead), "initial_pose_subscriber_status")
    assert report.level == b"\x00"
    matched.scans.publish(encode(street_scan(), ahead, "base_link"))
    assert "s in the future: check the clocks" in matched.report_of(nanoseconds(ahead)).message
    spin_until(matched.node, lambda: nanoseconds(ahead) in matched.poses)
    assert error_m(matched.pose_of(street_scan(), NEAR)) < 0.1


def test_the_sensor_is_mounted_somewhere(matched):
    T_base_lidar = from_xyz_rpy((1.2, 0.0, 0.4), (0.0, 0.1, 0.5))
    kept = QoSProfile(depth=1, durability=DurabilityPolicy.TRANSIENT_LOCAL)
    mounting = matched.node.create_publisher(TFMessage, "/tf_static", kept)
    stamp = matched.stamp()
    mounting.publish(
        TFMessage(transforms=[transform_stamped(T_base_lidar, stamp, "base_link", "lidar")])
    )
    points = transform(inverse(T_base_lidar), street_scan())
    message = encode(points, stamp, "lidar")
    spin_until(matched.node, mounting.get_subscription_count)
    spin_until(matched.node, lambda: "TF" not in matched.report_of(matched.send(message)).message)
    assert error_m(matched.pose_of(message, NEAR)) < 0.1


@pytest.mark.parametrize(
    ("parameters", "words"),
    [
        ({"ndt__resolution": -1.0}, "ndt.resolution: expected at least 0.1"),
        ({"ndt__resolution": ".nan"}, "ndt.resolution: expected at least 0.1"),
        ({"ndt__max_iterations": 0}, "ndt.max_iterations: expected at least 1"),
        ({"ndt__search": "kdtree"}, "expected one of radius, direct7, direct1, found 'kdtree'"),
        ({"ndt__step_size": "fast"}, "ndt.step_size: expected a number"),
        ({"covariance__output_pose_covariance": "[1.0]"}, "36 finite numbers"),
        (
            {"covariance__covariance_estimation__initial_pose_offset_model_x": "[1.0]"},
            "expected equally many numbers in both, found 1 and 6",
        ),
        ({"covariance__covariance_estimation__temperature": 0.0}, "temperature: expected more"),
        (
            {"score_estimation__no_ground_points__z_margin_for_ground_removal": ".nan"},
            "removal: expected finite, found nan",
        ),
        ({"frame__map_frame": "''"}, "map_frame: expected text that is not empty, found ''"),
        ({"worker_host_cpus": "[0.5]"}, "expected whole numbers, none negative, found (0.5,)"),
        ({"worker_host_cpus": "[-1]"}, "expected whole numbers, none negative, found (-1,)"),
        ({"worker_host_cpus": "[0, 4095]"}, "host CPU 4095 is not in this process's affinity mask"),
        ({"map_path": "/nonexistent.pcd"}, "no such file"),
        ({"map_path": "a" * 300}, "File name too long"),
        ({"map_path": "/etc/passwd"}, "ends in .pcd, .ply, .npz"),
    ],
)
def test_wrong_parameters_end_the_node_with_a_message(start, parameters, words):
    program = start(matcher_command(**parameters))
    assert program.wait() == 2
    assert words in program.output
    assert "Traceback" not in program.output
