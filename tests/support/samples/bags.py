# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""Small bags in the formats of ROS 1 and ROS 2, written with rosbags."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import numpy as np

from rmw_manycore_py.ndt.geometry.poses import to_quaternion

T0_S = 1_700_000_000
DATATYPES = {"i1": 1, "u1": 2, "i2": 3, "u2": 4, "i4": 5, "u4": 6, "f4": 7, "f8": 8}


class Bag:
    """A bag that is being written; times are seconds after T0_S.

    :param kind: ros1, sqlite3 or mcap.
    :param compression: for ros1 a format (bz2, lz4); else a mode (file, message, storage).
    :param stamped: whether messages have stamps.
    """

    def __init__(
        self, path: Path, kind: str = "sqlite3", compression: str = "", stamped: bool = True
    ) -> None:
        self._is_ros1 = kind == "ros1"
        self.path = path.with_suffix(".bag") if self._is_ros1 else path
        self._stamped = stamped
        self._store = _types(self._is_ros1)
        self._writer = (_ros1_writer if self._is_ros1 else _ros2_writer)(
            self.path, kind, compression
        )
        self._connections: dict[str, Any] = {}

    def __enter__(self) -> Bag:
        self._writer.open()
        return self

    def __exit__(self, *_: object) -> None:
        self._writer.close()

    def make(self, name: str, *values: Any) -> Any:
        """Return a message; its type is named as in ROS 2, without `/msg/`."""
        return self._store.types[name.replace("/", "/msg/")](*values)

    def write(self, topic: str, message: Any, time_s: float) -> None:
        kind = message.__msgtype__
        if topic not in self._connections:
            self._connections[topic] = self._writer.add_connection(
                topic, kind, typestore=self._store
            )
        serialize = self._store.serialize_ros1 if self._is_ros1 else self._store.serialize_cdr
        self._writer.write(self._connections[topic], _ns(time_s), serialize(message, kind))

    def header(self, time_s: float, frame: str) -> Any:
        ns = _ns(time_s) if self._stamped else 0
        stamp = self.make("builtin_interfaces/Time", *divmod(ns, 10**9))
        return self.make("std_msgs/Header", *([0] if self._is_ros1 else []), stamp, frame)

    def pose(self, T: np.ndarray) -> Any:
        point = self.make("geometry_msgs/Point", *T[:3, 3].tolist())
        return self.make("geometry_msgs/Pose", point, self._quaternion(T))

    def transform(self, time_s: float, parent: str, child: str, T: np.ndarray) -> Any:
        vector = self.make("geometry_msgs/Vector3", *T[:3, 3].tolist())
        moved = self.make("geometry_msgs/Transform", vector, self._quaternion(T))
        header = self.header(time_s, parent)
        return self.make("geometry_msgs/TransformStamped", header, child, moved)

    def transforms(self, *transforms: Any) -> Any:
        return self.make("tf2_msgs/TFMessage", list(transforms))

    def odometry(self, time_s: float, T: np.ndarray) -> Any:
        zero = self.make("geometry_msgs/Vector3", 0.0, 0.0, 0.0)
        twist = self.make("geometry_msgs/Twist", zero, zero)
        return self.make(
            "nav_msgs/Odometry",
            self.header(time_s, "map"),
            "base_link",
            self.make("geometry_msgs/PoseWithCovariance", self.pose(T), np.zeros(36)),
            self.make("geometry_msgs/TwistWithCovariance", twist, np.zeros(36)),
        )

    def pose_stamped(self, time_s: float, T: np.ndarray) -> Any:
        return self.make("geometry_msgs/PoseStamped", self.header(time_s, "map"), self.pose(T))

    def pose_with_covariance(self, time_s: float, T: np.ndarray) -> Any:
        pose = self.make("geometry_msgs/PoseWithCovariance", self.pose(T), np.zeros(36))
        return self.make(
            "geometry_msgs/PoseWithCovarianceStamped", self.header(time_s, "map"), pose
        )

    def cloud(self, time_s: float, records: np.ndarray, frame: str = "lidar") -> Any:
        """Return a PointCloud2 of a structured array (height, width)."""
        fields = []
        for name, (number, offset) in records.dtype.fields.items():
            datatype = DATATYPES[number.newbyteorder("<").str[1:]]
            fields.append(self.make("sensor_msgs/PointField", name, offset, datatype, 1))
        height, width = records.shape
        step = records.dtype.itemsize
        data = np.frombuffer(records.tobytes(), np.uint8)
        is_big = records.dtype["x"].byteorder == ">"
        header = self.header(time_s, frame)
        return self.make(
            *("sensor_msgs/PointCloud2", header, height, width, fields, is_big),
            *(step, step * width, data, False),
        )

    def _quaternion(self, T: np.ndarray) -> Any:
        return self.make("geometry_msgs/Quaternion", *to_quaternion(T[:3, :3]).tolist())


def _ns(time_s: float) -> int:
    return T0_S * 10**9 + round(1e9 * time_s)


def _types(is_ros1: bool) -> Any:
    from rosbags.typesys import Stores, get_types_from_msg, get_typestore

    if not is_ros1:
        return get_typestore(Stores.ROS2_JAZZY)
    store = get_typestore(Stores.ROS1_NOETIC)
    definition = "geometry_msgs/TransformStamped[] transforms"
    store.register(get_types_from_msg(definition, "tf2_msgs/msg/TFMessage"))
    return store


def _ros1_writer(path: Path, _: str, compression: str) -> Any:
    from rosbags.rosbag1 import Writer

    writer = Writer(path)
    if compression:
        writer.set_compression(Writer.CompressionFormat[compression.upper()])
    return writer


def _ros2_writer(path: Path, kind: str, compression: str) -> Any:
    from rosbags.rosbag2 import CompressionFormat, CompressionMode, StoragePlugin, Writer

    writer = Writer(path, version=9, storage_plugin=StoragePlugin[kind.upper()])
    if compression:
        writer.set_compression(CompressionMode[compression.upper()], CompressionFormat.ZSTD)
    return writer
