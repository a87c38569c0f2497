# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""A recording as a rosbag2 (sqlite3 or mcap), or a ROS 1 bag, read with `rosbags`.

Scans are PointCloud2 of any layout; poses are Odometry, PoseStamped or PoseWithCovarianceStamped,
taken to the LiDAR's frame with `/tf_static`, or a file of them.
"""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import contextmanager
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np

from rmw_manycore_py.errors import EXIT_BAD_INPUT, ManycoreError
from rmw_manycore_py.ndt.poses import Matrix
from rmw_manycore_py.ndt.recording import Recording
from rmw_manycore_py.ndt.recordings.matching import recorded
from rmw_manycore_py.ndt.recordings.pose_file import PoseLine, read_poses
from rmw_manycore_py.ndt.thinning import Points

CLOUD = "sensor_msgs/msg/PointCloud2"
POSE_DEPTHS = {  # how many times `.pose` leads to the pose
    "nav_msgs/msg/Odometry": 2,
    "geometry_msgs/msg/PoseStamped": 1,
    "geometry_msgs/msg/PoseWithCovarianceStamped": 2,
}
SUFFIXES = (".bag", ".mcap", ".db3")


def is_bag(path: Path) -> bool:
    """Tell whether a path looks like a bag."""
    return path.suffix in SUFFIXES or (path / "metadata.yaml").is_file()


@dataclass(frozen=True)
class BagScans:
    """Scans in a bag that is open, read when they are asked for."""

    reader: Any
    connections: tuple[Any, ...]  # of one topic: one for each publisher that it had
    times_ns: tuple[int, ...]  # when they were recorded

    def __getitem__(self, index: int) -> Points:
        """Read a scan; a broken one is a ManycoreError."""
        from rmw_manycore_py.ndt.nodes.point_cloud import CloudError, decode

        at_ns = self.times_ns[index]
        with _bad_bag(f"scan {index} of the bag"):
            found = self.reader.messages(self.connections, start=at_ns, stop=at_ns + 1)
            connection, _, data = next(iter(found))
            message = self.reader.deserialize(data, connection.msgtype)
        try:
            return decode(message)
        except CloudError as error:
            raise ManycoreError(f"scan {index} of the bag: {error}", EXIT_BAD_INPUT) from error


def open_bag(path: Path, poses_path: Path | None, topic: str, pose_topic: str) -> Recording:
    """Return the recording in a bag; of topics that are not named there must be one."""
    reader = _opened(path)
    connections = _connections(path, reader, {CLOUD}, topic, "--topic")
    stamps, times, frames = [], [], []
    with _bad_bag(f"{path}: a broken bag"):
        for connection, at_ns, data in reader.messages(connections):
            header = reader.deserialize(data, connection.msgtype).header
            times.append(at_ns)
            stamps.append(_seconds(header.stamp) or 1e-9 * at_ns)
            frames.append(header.frame_id)
        if poses_path is not None:
            line = read_poses(poses_path)
        else:
            line = _poses(path, reader, pose_topic, frames[0] if frames else "")
    scans = BagScans(reader, connections, tuple(times))
    return recorded(path, scans, len(times), np.array(stamps), line)


@contextmanager
def _bad_bag(what: str) -> Iterator[None]:
    """Turn whatever reading a broken bag ends in into a ManycoreError."""
    try:
        yield
    except ManycoreError:
        raise
    except Exception as error:  # rosbags and its decoders do not promise a class of errors
        raise ManycoreError(f"{what}: {error!r}", EXIT_BAD_INPUT) from error


def _opened(path: Path) -> Any:
    try:
        from rosbags.highlevel import AnyReader
        from rosbags.typesys import Stores, get_typestore
    except ImportError as error:
        raise ManycoreError(
            f"bags are read with rosbags ({error}): pip install 'rmw-manycore[ndt]'"
        ) from error
    with _bad_bag(f"{path}: no bag"):
        reader = AnyReader([path], default_typestore=get_typestore(Stores.ROS2_JAZZY))
        reader.open()
    return reader


def _connections(
    path: Path, reader: Any, kinds: set[str], topic: str, option: str
) -> tuple[Any, ...]:
    """Return the connections of a topic, or of the only one of some types."""
    fitting = [one for one in reader.connections if one.msgtype in kinds]
    chosen = [one for one in fitting if not topic or one.topic == topic]
    if len({(one.topic, one.msgtype) for one in chosen}) == 1:
        return tuple(chosen)
    names = ", ".join(f"{one.topic} ({one.msgtype})" for one in fitting) or "none"
    expected = f"the topic {topic}" if topic else "one topic"
    raise ManycoreError(
        f"{path}: expected {expected} of the type {' or '.join(sorted(kinds))}, found {names}: "
        f"name one with {option}",
        EXIT_BAD_INPUT,
    )


def _poses(path: Path, reader: Any, topic: str, cloud_frame: str) -> PoseLine:
    """Return the poses of a topic, of the LiDAR where the bag knows where that is mounted."""
    kinds = set(POSE_DEPTHS)
    connections = _connections(path, reader, kinds, topic, "--pose-topic, or a file with --poses")
    from rmw_manycore_py.ndt.nodes.conversions import PoseError, matrix_of

    stamps: list[float] = []
    found: list[Matrix] = []
    child = ""
    for connection, _, data in reader.messages(connections):
        message = reader.deserialize(data, connection.msgtype)
        child = getattr(message, "child_frame_id", "base_link")
        pose = message.pose if POSE_DEPTHS[connection.msgtype] == 1 else message.pose.pose
        stamp_s = _seconds(message.header.stamp)
        if stamps and stamp_s <= stamps[-1]:
            continue
        try:
            found.append(matrix_of(pose))
        except PoseError as error:
            raise ManycoreError(f"{path}: {connection.topic}: {error}", EXIT_BAD_INPUT) from error
        stamps.append(stamp_s)
    T_base_lidar = _mounting(reader, child, cloud_frame)
    return PoseLine(np.array(found).reshape(-1, 4, 4) @ T_base_lidar, np.array(stamps))


def _mounting(reader: Any, base: str, lidar: str) -> Matrix:
    """Return T_base_lidar of `/tf_static`, the identity where it says nothing."""
    from rmw_manycore_py.ndt.nodes.frame_tree import FrameError, FrameTree

    tree = FrameTree()
    static = [one for one in reader.connections if one.topic.endswith("tf_static")]
    for _, _, data in reader.messages(static) if static else ():
        tree.add(reader.deserialize(data, static[0].msgtype))
    try:
        return tree.lookup(base, lidar)
    except FrameError:
        return np.eye(4)


def _seconds(stamp: Any) -> float:
    return float(stamp.sec) + 1e-9 * float(stamp.nanosec)
