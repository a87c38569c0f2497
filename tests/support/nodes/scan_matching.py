# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""A small street, and the rest of a stack around a scan matcher."""

from __future__ import annotations

import os
import signal
import threading
import time
import zipfile
from collections.abc import Iterator, Sequence
from contextlib import contextmanager, suppress
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from diagnostic_msgs.msg import DiagnosticArray
from geometry_msgs.msg import PoseStamped, PoseWithCovarianceStamped
from rclpy.node import Node
from rclpy.qos import DurabilityPolicy, QoSProfile
from sensor_msgs.msg import PointCloud2
from std_srvs.srv import SetBool

from rmw_manycore_py.native import _transport
from rmw_manycore_py.ndt.geometry import poses
from rmw_manycore_py.ndt.messages.conversions import matrix_of, nanoseconds, pose_with_covariance
from rmw_manycore_py.ndt.messages.point_cloud import encode
from rmw_manycore_py.ndt.simulation.drive import poses_along
from rmw_manycore_py.ndt.simulation.lidar import Lidar
from rmw_manycore_py.ndt.simulation.street import build_street
from support import TIMEOUT_S
from support.nodes.ros import spin_until
from support.peers.programs import forked_node

LIDAR = Lidar(rings=16, azimuths=360)
COVARIANCE = np.diag([0.04, 0.04, 0.04, 0.01, 0.01, 0.01])
TRUTH = poses_along([5.0])[0]
NEAR = poses.perturbed(TRUTH, 0.3, 0.03, np.random.default_rng(3))


def command(module: str, *parameters: str) -> list[str]:
    """Return the command of a node, with parameters as NAME:=VALUE."""
    return forked_node(f"rmw_manycore_py.ndt.nodes.{module}", *ros_arguments(parameters))


def ros_arguments(parameters: Sequence[str], remappings: Sequence[str] = ()) -> list[str]:
    """Return the `--ros-args` arguments that set parameters and remap names."""
    options = [("-p", parameter) for parameter in parameters]
    options += [("-r", remapping) for remapping in remappings]
    return ["--ros-args", *(word for option in options for word in option)]


def matcher_command(**parameters: object) -> list[str]:
    """Return the command of an activated matcher."""
    values = {"activated": "true", **parameters}
    words = (f"{name.replace('__', '.')}:={value}" for name, value in values.items())
    return command("ndt_scan_matcher", *words)


def street_map() -> np.ndarray:
    """Return the points (N, 3) [m, map frame] of a map made from six poses."""
    generator = np.random.default_rng(1)
    street = build_street(10.0, generator)
    places = poses_along(np.arange(-5.0, 20.0, 4.0), side_m=0.5)
    scans = [poses.transform(T, LIDAR.scan(street, T, generator)) for T in places]
    return np.concatenate(scans)


def street_scan(T: np.ndarray = TRUTH) -> np.ndarray:
    """Return the points that the LiDAR sees in the street of the map."""
    street = build_street(10.0, np.random.default_rng(1))
    return LIDAR.scan(street, T, np.random.default_rng(2))


def few(count: int) -> np.ndarray:
    return np.float32([[15.0, n, 0.0] for n in range(count)])


def nan_points() -> np.ndarray:
    return np.full((100, 3), np.nan, np.float32)


def write_boastful_npz(path: Path) -> None:
    """Write a file whose header announces a petabyte, as a few flipped bits may do."""
    with zipfile.ZipFile(path, "w") as file, file.open("points.npy", "w") as points:
        header = {"descr": "<f4", "fortran_order": False, "shape": (1 << 48, 3)}
        np.lib.format.write_array_header_1_0(points, header)


def two_host_cpus() -> list[int]:
    """Return CPUs for two workers; skip the test where there is only one."""
    cpus = sorted(os.sched_getaffinity(0))[:2]
    if len(cpus) < 2:
        pytest.skip("workers need two host CPUs")
    return cpus


def workers_below(pid: int) -> list[int]:
    """Return the worker processes among the descendants of a process."""
    found: list[int] = []
    for children in Path(f"/proc/{pid}/task").glob("*/children"):
        for child in map(int, children.read_text().split()):
            is_worker = "ndt_worker" in Path(f"/proc/{child}/cmdline").read_text()
            found += [child] if is_worker else workers_below(child)
    return sorted(found)


@contextmanager
def killed_as_they_come(pid: int) -> Iterator[None]:
    """Kill the workers of a process repeatedly, before they have done any work."""
    enough = threading.Event()

    def kill() -> None:
        while not enough.is_set():
            with suppress(FileNotFoundError, ProcessLookupError):  # it has ended in the meantime
                for worker in workers_below(pid):
                    os.kill(worker, signal.SIGKILL)

    thread = threading.Thread(target=kill)
    thread.start()
    try:
        yield
    finally:
        enough.set()
        thread.join()


class Stack:
    """Publishers and subscriptions of a stack, at the test's node."""

    def __init__(self, node: Node) -> None:
        self.node = node
        self.poses: dict[int, np.ndarray] = {}
        self.reports: list[Any] = []
        kept = QoSProfile(depth=1, durability=DurabilityPolicy.TRANSIENT_LOCAL)
        self.maps = node.create_publisher(PointCloud2, "pointcloud_map", kept)
        self.guesses = node.create_publisher(
            PoseWithCovarianceStamped, "ekf_pose_with_covariance", 10
        )
        self.scans = node.create_publisher(PointCloud2, "points_raw", 5)
        node.create_subscription(PoseStamped, "ndt_pose", self._on_pose, 10)
        node.create_subscription(DiagnosticArray, "/diagnostics", self._on_report, 1000)

    def _on_pose(self, message: Any) -> None:
        self.poses[nanoseconds(message.header.stamp)] = matrix_of(message.pose)

    def _on_report(self, message: Any) -> None:
        self.reports += [(nanoseconds(message.header.stamp), status) for status in message.status]

    def wait_for_matcher(self) -> None:
        """Wait until all endpoints are matched."""
        ends = (self.maps, self.guesses, self.scans)
        spin_until(self.node, lambda: all(end.get_subscription_count() for end in ends))
        spin_until(self.node, lambda: self.node.count_services("ndt_align_tier4_srv"))  # its last

    def stamp(self) -> Any:
        """Return the current time."""
        return self.node.get_clock().now().to_msg()

    def publish_map(self, points: np.ndarray) -> None:
        self.maps.publish(encode(points, self.stamp(), "map"))

    def send(self, scan: Any, guess: Any = TRUTH, stamp: Any = None) -> int:
        """Publish a guess, then its scan (points or a message); return the stamp [ns]."""
        stamp = stamp or self.stamp()
        if guess is not None:
            message = guess
            if isinstance(guess, np.ndarray):
                message = pose_with_covariance(guess, COVARIANCE, stamp, "map")
            for _ in range(2):
                message.header.stamp = stamp
                self.guesses.publish(message)
        message = encode(scan, stamp, "base_link") if isinstance(scan, np.ndarray) else scan
        message.header.stamp = stamp
        self.scans.publish(message)
        return nanoseconds(stamp)

    def report_of(self, stamp_ns: int, name: str = "scan_matching_status") -> Any:
        """Wait for the diagnostics of a scan, and return them."""

        def found() -> list[Any]:
            return [s for at, s in self.reports if at == stamp_ns and s.name.endswith(name)]

        spin_until(self.node, found)
        return found()[0]

    def next_report(self, name: str, level: bytes) -> Any:
        """Wait for new diagnostics of this kind and level, and return them."""
        self.reports.clear()

        def found() -> list[Any]:
            return [s for _, s in self.reports if s.name.endswith(name) and s.level == level]

        spin_until(self.node, found)
        return found()[0]

    def pose_of(self, scan: Any, guess: Any = TRUTH) -> np.ndarray:
        """Publish scans until one gets a pose: the map may still be loading.

        A warning does not withhold the pose: on a busy machine matching takes long.
        """
        deadline = time.monotonic() + TIMEOUT_S
        while not has_pose(report := self.report_of(stamp_ns := self.send(scan, guess))):
            assert time.monotonic() < deadline, f"no pose: {report}"
        spin_until(self.node, lambda: stamp_ns in self.poses)
        return self.poses[stamp_ns]

    def be_sure(self) -> None:
        """Publish scans until their poses confirm each other."""
        deadline = time.monotonic() + TIMEOUT_S
        while {pair.key: pair.value for pair in self._answer().values}.get("is_sure") != "True":
            assert time.monotonic() < deadline, "no pose is sure"

    def begin_anew(self) -> None:
        """Make the matcher drop its last pose, as a first pose would."""
        trigger = self.node.create_client(SetBool, "trigger_node_srv")
        assert trigger.wait_for_service(TIMEOUT_S)
        answer = trigger.call_async(SetBool.Request(data=True))
        spin_until(self.node, answer.done)
        self.node.destroy_client(trigger)

    def _answer(self) -> Any:
        return self.report_of(self.send(street_scan(), NEAR))


def has_pose(report: Any) -> bool:
    """Return whether the report of a scan says that its pose was published."""
    values = {pair.key: pair.value for pair in report.values}
    return "execution_time" in values and values["skipping_publish_num"] == "0"


def error_m(T: np.ndarray) -> float:
    """Return the distance [m] of a pose from the truth."""
    return poses.distance_m(T, TRUTH)


def own_cluster() -> _transport.ClusterInfo:
    """Return the state of cluster 1."""
    with _transport.Platform(os.environ["MANYCORE_PLATFORM"]) as platform:
        return platform.clusters()[0]
