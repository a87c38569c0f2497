# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""Stores the last believed pose in a file, for the process that replaces a killed one.

Written after each believed scan, in a few microseconds: the file stays mapped and is not synced.
The data survives the process, not the machine.
"""

from __future__ import annotations

import mmap
import os
import struct
import zlib
from pathlib import Path

import numpy as np

from rmw_manycore_py.errors import EXIT_BAD_INPUT, ManycoreError
from rmw_manycore_py.ndt.geometry.arrays import Pose
from rmw_manycore_py.ndt.geometry.poses import rigid
from rmw_manycore_py.ndt.trust.motion import Believed

MAGIC = b"manycore last pose 1\0\0\0\0"
BODY = struct.Struct("<24sdd?16d16d")
CHECK = struct.Struct("<I")
SIZE = BODY.size + CHECK.size
NO_GUESS = np.zeros((4, 4))


class LastPose:
    """The mapped file; must not be shared by several processes.

    :raises ManycoreError: if the file cannot be created.
    """

    def __init__(self, path: Path) -> None:
        try:
            descriptor = os.open(path, os.O_RDWR | os.O_CREAT | os.O_CLOEXEC, 0o600)
            try:
                os.ftruncate(descriptor, SIZE)
                self._bytes = mmap.mmap(descriptor, SIZE)
            finally:
                os.close(descriptor)
        except (OSError, ValueError) as error:
            raise ManycoreError(
                f"parameter last_pose_path: {path} cannot be written: {error}", EXIT_BAD_INPUT
            ) from error

    def write(self, now_s: float, believed: Believed, is_activated: bool) -> None:
        """Store a pose, replacing the previous one.

        :param now_s: wall-clock time; stamps may be of another clock, e.g. of a recording.
        """
        guess = NO_GUESS if believed.guess is None else believed.guess
        numbers = (*believed.T.ravel(), *guess.ravel())
        body = BODY.pack(MAGIC, now_s, believed.stamp_s, is_activated, *numbers)
        self._bytes[:] = body + CHECK.pack(zlib.crc32(body))

    def read(self, now_s: float, max_age_s: float) -> tuple[Believed, bool] | None:
        """Return the pose left by a previous process, and whether it was activated.

        None if there is none, or if it is incomplete, too old or in the future.
        """
        data = bytes(self._bytes)
        body = data[: BODY.size]
        if CHECK.unpack(data[BODY.size :])[0] != zlib.crc32(body):
            return None
        magic, written_s, stamp_s, is_activated, *numbers = BODY.unpack(body)
        if magic != MAGIC or not 0.0 <= now_s - written_s <= max_age_s:
            return None
        T, guess = (_pose(np.array(part)) for part in (numbers[:16], numbers[16:]))
        return None if T is None else (Believed(stamp_s, T, guess), is_activated)

    def forget(self) -> None:
        """Remove the pose: the vehicle may be moved before the next start."""
        self._bytes[:] = bytes(SIZE)

    def close(self) -> None:
        """Unmap the file."""
        self._bytes.close()


def _pose(numbers: Pose) -> Pose | None:
    try:
        pose: Pose = rigid(numbers.reshape(1, 4, 4))[0]
    except ValueError:
        return None
    return pose
