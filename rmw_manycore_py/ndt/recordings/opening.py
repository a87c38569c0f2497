# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""Opens recordings of any kind."""

from __future__ import annotations

from pathlib import Path

from rmw_manycore_py.errors import EXIT_BAD_INPUT, ManycoreError
from rmw_manycore_py.ndt.files.cloud_file import suffix_of
from rmw_manycore_py.ndt.recordings.bag import SUFFIXES, is_bag, open_bag
from rmw_manycore_py.ndt.recordings.recording import Recording, load_recording
from rmw_manycore_py.ndt.recordings.scan_folder import open_folder


def open_recording(
    path: Path, poses_path: Path | None = None, topic: str = "", pose_topic: str = ""
) -> Recording:
    """Open the recording at a path: npz, a bag, or a directory of scans.

    Scans of the latter two are read on demand.

    :raises ManycoreError: if the path is no recording.
    """
    if is_bag(path):
        return open_bag(path, poses_path, topic, pose_topic)
    if path.is_dir():
        return open_folder(path, poses_path)
    if suffix_of(path) != ".npz":
        kinds = ", ".join((".npz", *SUFFIXES))
        raise ManycoreError(
            f"{path}: no recording: expected {kinds} or a directory of scans", EXIT_BAD_INPUT
        )
    return load_recording(path)
