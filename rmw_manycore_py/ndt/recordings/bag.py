# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""Recordings in rosbag2 (sqlite3 or mcap) or ROS 1 bags, read with `rosbags`.

Scans are PointCloud2 of any layout; poses come from a topic or `/tf` (bag_poses.py), or from a
file.
"""

from __future__ import annotations

import weakref
from collections.abc import Iterator
from contextlib import ExitStack, contextmanager
from dataclasses import dataclass
from itertools import islice
from pathlib import Path
from typing import Any

import numpy as np

from rmw_manycore_py.errors import EXIT_BAD_INPUT, ManycoreError
from rmw_manycore_py.errors.missing_library import ROSBAGS, require
from rmw_manycore_py.ndt.geometry.arrays import Matrix, Points
from rmw_manycore_py.ndt.recordings.bag_faults import (
    METADATA,
    bag_fault,
    damage,
    metadata_fault,
)
from rmw_manycore_py.ndt.recordings.bag_poses import poses_of
from rmw_manycore_py.ndt.recordings.connections import connections_of
from rmw_manycore_py.ndt.recordings.cut_bag import open_cut_bag
from rmw_manycore_py.ndt.recordings.matching import recorded
from rmw_manycore_py.ndt.recordings.pose_file import read_poses
from rmw_manycore_py.ndt.recordings.recording import Recording

CLOUD = "sensor_msgs/msg/PointCloud2"
SUFFIXES = (".bag", ".mcap", ".db3")


def is_bag(path: Path) -> bool:
    """Return whether a path looks like a bag."""
    if not path.is_dir():
        return path.suffix in SUFFIXES
    return (path / METADATA).is_file() or bool(_files_of(path))


@dataclass(frozen=True)
class BagScans:
    """Scans in an open bag, read on demand."""

    reader: Any
    connections: tuple[Any, ...]  # of one topic, one per publisher
    times_ns: tuple[int, ...]  # receive times
    closing: ExitStack  # closes the bag, once

    def __post_init__(self) -> None:
        weakref.finalize(self, self.closing.close)

    def __getitem__(self, index: int) -> Points:
        """Read a scan; raise ManycoreError if it is broken."""
        from rmw_manycore_py.ndt.messages.point_cloud import CloudError, decode

        message = self.message(index)
        try:
            return decode(message)
        except CloudError as error:
            raise ManycoreError(f"scan {index} of the bag: {error}", EXIT_BAD_INPUT) from error

    def message(self, index: int) -> Any:
        """Read the message of a scan; raise ManycoreError if it is broken."""
        at_ns = self.times_ns[index]
        with _bad_bag(f"scan {index} of the bag"):
            found = self.reader.messages(self.connections, start=at_ns, stop=at_ns + 1)
            nth = index - self.times_ns.index(at_ns)  # of those received at once
            connection, _, data = next(islice(found, nth, None))
            return self.reader.deserialize(data, connection.msgtype)


@dataclass(frozen=True)
class BagTimes:
    """Times of the points in a bag whose clouds have such a field."""

    scans: BagScans
    field: str

    def __getitem__(self, index: int) -> Matrix | None:
        """Return the times (n) of a scan's points, in seconds after its stamp; None if unknown."""
        times_s = self._found(index)
        return None if isinstance(times_s, Exception) else times_s

    def problem(self) -> str:
        """Return why the times of the first scan are not used; "" if they are."""
        from rmw_manycore_py.ndt.messages.point_times import TimesError

        times_s = self._found(0) if self.scans.times_ns else None
        return f"{times_s}: not used" if isinstance(times_s, TimesError) else ""

    def _found(self, index: int) -> Matrix | ValueError:
        from rmw_manycore_py.ndt.messages.point_cloud import CloudError
        from rmw_manycore_py.ndt.messages.point_times import decode_timed

        try:
            return decode_timed(self.scans.message(index), self.field)[1]
        except CloudError as error:
            return error


def open_bag(path: Path, poses_path: Path | None, topic: str, pose_topic: str) -> Recording:
    """Open the recording in a bag; topics that are not given must be unambiguous."""
    closing = ExitStack()
    try:
        return _recording_of(path, closing, poses_path, topic, pose_topic)
    except ManycoreError:
        closing.close()
        raise


def _recording_of(
    path: Path, closing: ExitStack, poses_path: Path | None, topic: str, pose_topic: str
) -> Recording:
    from rmw_manycore_py.ndt.messages.conversions import seconds
    from rmw_manycore_py.ndt.messages.point_times import time_field

    reader, cut = _opened(path)
    closing.callback(reader.close)
    connections = connections_of(path, reader, {CLOUD}, topic, "--topic")
    stamps, times, frames, fields = [], [], [], set()
    with _bad_bag(f"{path}: a broken bag"):
        for connection, at_ns, data in reader.messages(connections):
            message = reader.deserialize(data, connection.msgtype)
            header = message.header
            fields.add(time_field(message))
            times.append(at_ns)
            stamps.append(seconds(header.stamp) or 1e-9 * at_ns)
            frames.append(header.frame_id)
        if poses_path is not None:
            line, note = read_poses(poses_path), ""
        else:
            line, note = poses_of(path, reader, pose_topic, frames[0] if frames else "")
    scans = BagScans(reader, connections, tuple(times), closing)
    field = fields.pop() if len(fields) == 1 else None
    point_times = None if field is None else BagTimes(scans, field)
    remarks = [cut, note, "" if point_times is None else point_times.problem()]
    return recorded(path, scans, len(times), np.array(stamps), line, remarks, point_times)


@contextmanager
def _bad_bag(what: str) -> Iterator[None]:
    """Convert any error of reading a broken bag to ManycoreError."""
    try:
        yield
    except ManycoreError:
        raise
    except Exception as error:  # rosbags does not document its errors
        raise ManycoreError(f"{what}: {damage(error)}", EXIT_BAD_INPUT) from error


def _opened(path: Path) -> tuple[Any, str]:
    """Return a reader, and a remark if a part of the bag is missing."""
    require(ROSBAGS)
    from rosbags.highlevel import AnyReader
    from rosbags.typesys import Stores, get_typestore

    files = _files_of(path)
    is_complete = not path.is_dir() or (path / METADATA).is_file()
    try:
        reader = AnyReader(
            [path] if is_complete else files, default_typestore=get_typestore(Stores.ROS2_JAZZY)
        )
        reader.open()
    except Exception as error:  # rosbags does not document its errors
        described = metadata_fault(path)
        with _bad_bag(f"{path}: no bag"):
            cut_bag = open_cut_bag(files)
        if cut_bag is None:
            why = described or bag_fault(path, files, error)
            raise ManycoreError(f"{path}: no bag: {why}", EXIT_BAD_INPUT) from error
        if described:
            return cut_bag, f"{described}: its files are read"
        return cut_bag, f"its end is missing ({bag_fault(path, files, error)}): read up to there"
    return reader, "" if is_complete else f"it has no {METADATA}: its files are read"


def _files_of(path: Path) -> list[Path]:
    if not path.is_dir():
        return [path]
    return sorted(file for file in path.iterdir() if file.suffix in SUFFIXES)
