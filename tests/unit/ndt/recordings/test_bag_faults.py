# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""Bags that cannot be read: one line says what is wrong, and in which file."""

from __future__ import annotations

import re
import sqlite3
from pathlib import Path

import numpy as np
import pytest

from rmw_manycore_py.errors import EXIT_BAD_INPUT, ManycoreError
from rmw_manycore_py.ndt.recordings.opening import open_recording
from support.samples.bags import Bag

pytestmark = pytest.mark.unit

DAMAGED = "it is damaged or cut short"
ROOT = "rosbag2_bagfile_information:\n  version: {}\n  storage_identifier: mcap\n"


def fault_of(path: Path) -> str:
    """Return the error without the path, which has to be one line in plain words."""
    with pytest.raises(ManycoreError) as caught:
        open_recording(path)
    text = str(caught.value)
    assert caught.value.exit_status == EXIT_BAD_INPUT
    assert not re.search(r"\n|Error|<", text)
    prefix, _, fault = text.partition(": ")
    assert prefix == str(path)
    return fault


@pytest.mark.parametrize(
    ("name", "content", "fault"),
    [
        ("a.mcap", b"\x89MCAP0\r\n" + b"x" * 100, DAMAGED),
        ("a.mcap", b"", "it is empty"),
        ("a.mcap", b"hello", "expected an MCAP file, found another beginning"),
        ("a.db3", b"SQLite format 3\0" + b"x" * 100, DAMAGED),
        ("a.db3", b"", "it is empty"),
        ("a.db3", b"hello", "expected an SQLite file, found another beginning"),
        ("a.bag", b"#ROSBAG V2.0\nxx", DAMAGED),
        ("a.bag", b"", "it is empty"),
        ("a.bag", b"hello", "expected a ROS 1 bag, found another beginning"),
    ],
)
def test_files_that_are_no_bags(tmp_path: Path, name: str, content: bytes, fault: str) -> None:
    (tmp_path / name).write_bytes(content)
    assert fault_of(tmp_path / name) == f"no bag: {fault}"
    folder = tmp_path / "bag"
    folder.mkdir()
    (tmp_path / name).rename(folder / name)
    assert fault_of(folder) == f"no bag: {name}: {fault}"


def test_a_database_of_something_else(tmp_path: Path) -> None:
    with sqlite3.connect(tmp_path / "a.db3") as database:
        database.execute("CREATE TABLE cats (name TEXT)")
    assert fault_of(tmp_path / "a.db3") == "no bag: it has no tables of rosbag2"


@pytest.mark.parametrize(
    ("text", "fault"),
    [
        ("a: [\nb", "metadata.yaml: expected .* found no valid YAML in line 2; .*"),
        ("a: 1", "metadata.yaml: expected .* found no key 'rosbag2_bagfile_information'; .*"),
        ("hello", "metadata.yaml: expected .* found other values; .*"),
        (f"{ROOT.format(5)}  relative_file_paths: 3", "metadata.yaml: .* found other values; .*"),
        (
            "rosbag2_bagfile_information:\n  relative_file_paths: []",
            "metadata.yaml: it has no key 'version'",
        ),
        (
            f"{ROOT.format(5)}  relative_file_paths: [a_0.mcap]",
            "metadata.yaml: its file a_0.mcap is missing",
        ),
        (f"{ROOT.format(55)}  relative_file_paths: []", "Rosbag2 version 55 not supported"),
    ],
)
def test_metadata_that_describes_no_bag(tmp_path: Path, text: str, fault: str) -> None:
    (tmp_path / "metadata.yaml").write_text(text)
    assert re.fullmatch(f"no bag: {fault}", fault_of(tmp_path))


def test_metadata_of_no_text(tmp_path: Path) -> None:
    (tmp_path / "metadata.yaml").write_bytes(b"a: \xff")
    assert "found no text in YAML" in fault_of(tmp_path)


def write_bag(path: Path) -> None:
    with Bag(path, "mcap") as bag:
        for i in range(3):
            records = np.zeros((1, 4), [(axis, "<f4") for axis in "xyz"])
            bag.write("/points", bag.cloud(0.1 * i, records), 0.1 * i)
            bag.write("/odom", bag.odometry(0.1 * i, np.eye(4)), 0.1 * i)


def test_a_bag_with_broken_metadata_is_read_all_the_same(tmp_path: Path) -> None:
    write_bag(tmp_path / "bag")
    (tmp_path / "bag/metadata.yaml").write_text("a: [")
    drive = open_recording(tmp_path / "bag")
    assert len(drive) == 3
    assert "found no valid YAML in line 1" in drive.note
    assert "its files are read" in drive.note


def test_a_broken_message_is_no_error_of_python(tmp_path: Path) -> None:
    with Bag(tmp_path / "bag") as bag:
        records = np.zeros((1, 4), [(axis, "<f4") for axis in "xyz"])
        bag.write("/points", bag.cloud(0.0, records), 0.0)
        bag.write("/odom", bag.odometry(0.0, np.eye(4)), 0.0)
    with sqlite3.connect(next((tmp_path / "bag").glob("*.db3"))) as database:
        database.execute("UPDATE messages SET data = X'00010000'")
    assert fault_of(tmp_path / "bag") == f"a broken bag: {DAMAGED}"
