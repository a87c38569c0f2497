# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""What is wrong with a bag that `rosbags` refuses: its errors name parts of the formats."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path, PurePath

from rmw_manycore_py.errors import ManycoreError, shorten
from rmw_manycore_py.ndt.files.unreadable import DAMAGED

METADATA = "metadata.yaml"
_KINDS = {
    ".mcap": ("an MCAP file", b"\x89MCAP0\r\n"),
    ".db3": ("an SQLite file", b"SQLite format 3\0"),
    ".bag": ("a ROS 1 bag", b"#ROSBAG V2.0\n"),
}
# Words of rosbags' errors about intact files.
_REFUSALS = ("not supported", "Unsupported", "hash mismatch", "Profile is not ros2", "type def")


def damage(error: Exception) -> str:
    """Return why a message cannot be read."""
    if isinstance(error, MemoryError):
        return "it announces more data than memory can hold"
    return (error.strerror if isinstance(error, OSError) else None) or DAMAGED


def bag_fault(path: Path, files: Sequence[Path], error: Exception) -> str:
    """Return why rosbags refused a bag, in one line.

    :param files: its data files; the path itself if it is one.
    """
    text = str(error)
    if any(word in text for word in _REFUSALS):
        return shorten(text.removesuffix("; please report issue.").removesuffix("."), 200)
    for file in files:
        if fault := _fault_of(file):
            return fault if file == path else f"{file.name}: {fault}"
    fault = "it has no tables of rosbag2" if "missing tables" in text else damage(error)
    return f"{files[0].name}: {fault}" if len(files) == 1 and files[0] != path else fault


def metadata_fault(path: Path) -> str:
    """Return what is wrong with the metadata.yaml of a directory; "" if there is none."""
    from rmw_manycore_py.recording.metadata import read_metadata

    try:
        found = read_metadata(path) if path.is_dir() else None
    except ManycoreError as error:
        return str(error).removeprefix(f"{path}/")
    if found is None:
        return ""
    missing_keys = [key for key in ("version", "storage_identifier") if key not in found]
    if missing_keys:
        return f"{METADATA}: it has no key '{missing_keys[0]}'"
    names = [PurePath(str(name)).name for name in found["relative_file_paths"]]
    missing = [name for name in names if not (path / name).is_file()]
    return f"{METADATA}: its file {missing[0]} is missing" if missing else ""


def _fault_of(file: Path) -> str:
    """Return what is wrong with the begin of a file; "" if nothing is."""
    kind, begin = _KINDS[file.suffix]
    try:
        with file.open("rb") as content:
            found = content.read(len(begin))
    except OSError as error:
        return damage(error)
    if not found:
        return "it is empty"
    return "" if found == begin else f"expected {kind}, found another beginning"
