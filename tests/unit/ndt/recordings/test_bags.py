# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""Bags of all kinds: storages, drivers' layouts, and sources of the pose."""

from __future__ import annotations

import random
import sqlite3
from pathlib import Path

import numpy as np
import pytest

from rmw_manycore_py.errors import ManycoreError
from rmw_manycore_py.ndt.geometry.poses import from_xyz_rpy, inverse
from rmw_manycore_py.ndt.recordings.opening import open_recording
from support.samples.bags import T0_S, Bag

pytestmark = pytest.mark.unit

COUNT = 12
GENERATOR = np.random.default_rng(4)
SCANS = [GENERATOR.uniform(-20, 20, (48, 3)).astype(np.float32) for _ in range(COUNT)]
POSES = np.stack([from_xyz_rpy((i, 0.1 * i, 0.0), (0.0, 0.0, 0.05 * i)) for i in range(COUNT)])
T_BASE_LIDAR = from_xyz_rpy((1.0, 0.0, 2.0), (0.0, 0.1, 0.3))
OF_BASE = POSES @ inverse(T_BASE_LIDAR)
T_MAP_ODOM = from_xyz_rpy((30.0, -2.0, 1.0), (0.0, 0.0, 2.0))
XYZ = [(name, "<f4") for name in "xyz"]
LAYOUTS = {
    "plain": np.dtype(XYZ),
    "Velodyne": np.dtype([*XYZ, ("intensity", "<f4"), ("ring", "<u2"), ("time", "<f4")]),
    "Ouster": np.dtype(
        {
            "names": ["x", "y", "z", "intensity", "t", "reflectivity", "ring", "range"],
            "formats": ["<f4", "<f4", "<f4", "<f4", "<u4", "<u2", "u1", "<u4"],
            "offsets": [0, 4, 8, 16, 20, 24, 26, 32],
            "itemsize": 48,
        }
    ),
    "Livox": np.dtype([*XYZ, ("intensity", "<f4"), ("tag", "u1"), ("timestamp", "<f8")]),
    "big-endian": np.dtype([(name, ">f4") for name in ("intensity", "x", "y", "z")]),
    "doubles": np.dtype([(name, "<f8") for name in "xyz"]),
}


def records_of(points: np.ndarray, layout: str = "plain", height: int = 1) -> np.ndarray:
    """Return a cloud of `height` rows, each with an invalid point at its end."""
    records = np.zeros((height, len(points) // height + 1), LAYOUTS[layout])
    for axis, name in enumerate("xyz"):
        records[name][:, :-1] = points[:, axis].reshape(height, -1)
        records[name][:, -1] = np.nan
    return records


def write_scans(bag: Bag, layout: str = "plain", height: int = 1) -> None:
    for i, scan in enumerate(SCANS):
        bag.write("/points", bag.cloud(0.1 * i, records_of(scan, layout, height)), 0.1 * i)


def write_mounting(bag: Bag, topic: str = "/tf_static") -> None:
    mounted = bag.transform(0.0, "base_link", "lidar", T_BASE_LIDAR)
    bag.write(topic, bag.transforms(mounted), 0.0)


def write_poses(bag: Bag, kind: str = "odometry") -> None:
    for i, T in enumerate(OF_BASE):
        bag.write("/pose", getattr(bag, kind)(0.1 * i, T), 0.1 * i)


def check(drive, note="") -> None:
    assert len(drive) == COUNT
    assert drive.note.endswith(note)
    np.testing.assert_allclose(drive.poses, POSES, atol=1e-6)
    np.testing.assert_allclose(drive.stamps, T0_S + 0.1 * np.arange(COUNT), atol=1e-6)
    for index in (0, COUNT - 1):
        np.testing.assert_array_equal(drive.scan(index), SCANS[index])


@pytest.mark.parametrize(
    ("kind", "compression"),
    [
        *(("ros1", how) for how in ("", "bz2", "lz4")),
        *(("sqlite3", how) for how in ("", "file", "message")),
        *(("mcap", how) for how in ("", "file", "message", "storage")),
    ],
)
def test_storages(tmp_path, kind, compression):
    with Bag(tmp_path / "bag", kind, compression) as bag:
        write_mounting(bag)
        write_poses(bag)
        write_scans(bag, "Velodyne")
    check(open_recording(bag.path))
    with pytest.raises(ManycoreError, match=r"expected the topic /x .*found /points .*--topic"):
        open_recording(bag.path, topic="/x")


@pytest.mark.parametrize("height", [1, 4])
@pytest.mark.parametrize("layout", LAYOUTS)
def test_layouts_of_drivers(tmp_path, layout, height):
    with Bag(tmp_path / "bag", "mcap") as bag:
        write_mounting(bag)
        write_poses(bag)
        write_scans(bag, layout, height)
    check(open_recording(bag.path))


@pytest.mark.parametrize("stamped", [True, False])
@pytest.mark.parametrize("kind", ["odometry", "pose_stamped", "pose_with_covariance", "transform"])
def test_poses_of_a_topic(tmp_path, kind, stamped):
    """Messages without stamps get the time at which they were recorded."""
    with Bag(tmp_path / "bag", stamped=stamped) as bag:
        write_mounting(bag)
        if kind == "transform":
            for i, T in enumerate(OF_BASE):
                bag.write("/vicon", bag.transform(0.1 * i, "world", "base_link", T), 0.1 * i)
        else:
            write_poses(bag, kind)
        write_scans(bag)
    check(open_recording(bag.path))


def write_transforms(bag: Bag) -> None:
    """Write a map that is corrected every half second, odometry below it, and a wheel."""
    for i, T in enumerate(OF_BASE):
        time_s = 0.1 * i
        if i % 5 == 0 or i == COUNT - 1:
            correction = from_xyz_rpy((0.02 * i, 0.0, 0.0)) @ T_MAP_ODOM
            bag.write(
                "/tf", bag.transforms(bag.transform(time_s, "map", "odom", correction)), time_s
            )
        corrected = from_xyz_rpy((0.02 * i, 0.0, 0.0)) @ T_MAP_ODOM
        moved = bag.transform(time_s, "odom", "base_link", inverse(corrected) @ T)
        turned = bag.transform(time_s, "base_link", "wheel", from_xyz_rpy((0, 0, 0), (0, i, 0)))
        bag.write("/tf", bag.transforms(moved, turned), time_s)


@pytest.mark.parametrize("kind", ["ros1", "mcap"])
@pytest.mark.parametrize("mounting", ["/tf_static", "/tf"])
def test_poses_of_transforms_alone(tmp_path, kind, mounting):
    """As in ROS 1, static transforms may be on `/tf`, too."""
    with Bag(tmp_path / "bag", kind) as bag:
        write_mounting(bag, mounting)
        write_transforms(bag)
        write_scans(bag)
    check(open_recording(bag.path), "poses are those of /tf")


def test_transforms_instead_of_a_topic(tmp_path):
    with Bag(tmp_path / "bag") as bag:
        write_mounting(bag)
        write_transforms(bag)
        bag.write("/goal", bag.pose_stamped(0.0, POSES[3]), 0.0)
        write_scans(bag)
    check(open_recording(bag.path, pose_topic="/tf"), "poses are those of /tf")


def test_a_lidar_that_no_transform_knows(tmp_path):
    """Its poses are taken as those of the base, with a note; with /tf alone that is an error."""
    with Bag(tmp_path / "bag") as bag:
        write_poses(bag)
        write_scans(bag)
    drive = open_recording(bag.path)
    assert "no transform connects 'base_link' and 'lidar': taken for the same" in drive.note
    np.testing.assert_allclose(drive.poses, OF_BASE, atol=1e-6)
    with Bag(tmp_path / "other") as bag:
        write_transforms(bag)
        write_scans(bag)
    with pytest.raises(ManycoreError, match="or /tf with the motion of 'lidar', found neither"):
        open_recording(bag.path)


def test_transforms_in_a_circle(tmp_path):
    with Bag(tmp_path / "bag") as bag:
        for parent, child in (("a", "lidar"), ("lidar", "b"), ("b", "a")):
            bag.write("/tf", bag.transforms(bag.transform(0.0, parent, child, np.eye(4))), 0.0)
        write_scans(bag)
    with pytest.raises(ManycoreError, match="found neither"):
        open_recording(bag.path)


def test_poses_of_another_time(tmp_path):
    with Bag(tmp_path / "bag") as bag:
        for i in range(COUNT):
            bag.write("/pose", bag.pose_stamped(100.0 + i, POSES[i]), 100.0 + i)
        write_scans(bag)
    with pytest.raises(ManycoreError, match="no scan has a pose near its time"):
        open_recording(bag.path)


def data_file(bag: Bag) -> Path:
    if bag.path.is_file():
        return bag.path
    (file,) = (f for f in bag.path.iterdir() if f.suffix != ".yaml")
    return file


@pytest.mark.parametrize(
    ("kind", "compression"),
    [
        ("sqlite3", ""),
        ("mcap", ""),
        ("mcap", "storage"),
        *(("ros1", c) for c in ("", "bz2", "lz4")),
    ],
)
def test_a_bag_that_was_cut_is_read_up_to_there(tmp_path, kind, compression):
    """Without what is written at the end: metadata.yaml, and a part of the file."""
    scans = [np.tile(scan, (30, 1)) for scan in SCANS]  # some chunks
    with Bag(tmp_path / "bag", kind, compression) as bag:
        for i in range(200):
            bag.write("/points", bag.cloud(0.1 * i, records_of(scans[i % COUNT])), 0.1 * i)
            bag.write("/odom", bag.odometry(0.1 * i, POSES[i % COUNT]), 0.1 * i)
    file = data_file(bag)
    whole = file.read_bytes()
    if bag.path.is_dir():
        (bag.path / "metadata.yaml").unlink()
    counts = []
    for share in (0.9, 0.7, 0.45):
        file.write_bytes(whole[: int(share * len(whole))])
        drive = open_recording(bag.path)
        assert "its end is missing" in drive.note
        counts.append(len(drive))
        for index in (0, len(drive) - 1):
            np.testing.assert_array_equal(drive.scan(index), scans[index % COUNT])
            np.testing.assert_allclose(drive.poses[index], POSES[index % COUNT], atol=1e-9)
        assert drive.stamps[-1] == pytest.approx(T0_S + 0.1 * (len(drive) - 1))
    assert 200 >= counts[0] >= counts[1] > counts[2] > 0
    file.write_bytes(whole[:50])
    with pytest.raises(ManycoreError, match="no bag"):
        open_recording(bag.path)


@pytest.mark.parametrize("kind", ["sqlite3", "mcap", "ros1"])
def test_no_damage_leads_to_another_error(tmp_path, kind):
    """Damaged bytes, and an end that is missing."""
    with Bag(tmp_path / "bag", kind) as bag:
        write_scans(bag)
        for i, T in enumerate(POSES):
            bag.write("/odom", bag.odometry(0.1 * i, T), 0.1 * i)
    file = data_file(bag)
    whole, chance = file.read_bytes(), random.Random(1)
    for _ in range(60):
        damaged = bytearray(whole)
        for _ in range(chance.choice((1, 3, 20))):
            damaged[chance.randrange(len(damaged))] = chance.randrange(256)
        file.write_bytes(damaged[: chance.choice((None, chance.randrange(len(damaged))))])
        try:
            drive = open_recording(bag.path)
            drive.scan(0)
        except ManycoreError:
            pass


@pytest.mark.parametrize("kind", ["sqlite3", "mcap"])
def test_a_bag_without_its_metadata_is_read(tmp_path, kind):
    with Bag(tmp_path / "bag", kind) as bag:
        write_scans(bag)
        for i, T in enumerate(POSES):
            bag.write("/odom", bag.odometry(0.1 * i, T), 0.1 * i)
    (bag.path / "metadata.yaml").unlink()
    drive = open_recording(bag.path)
    assert len(drive) == COUNT
    assert "it has no metadata.yaml: its files are read" in drive.note


@pytest.mark.parametrize("wrong_s", [0.4, 0.1, 1e6])
def test_a_scan_or_pose_with_a_wrong_stamp_is_left_out(tmp_path, wrong_s):
    with Bag(tmp_path / "bag") as bag:
        for i, (scan, T) in enumerate(zip(SCANS, POSES, strict=True)):
            at_s = wrong_s if i == 5 else 0.1 * i
            bag.write("/points", bag.cloud(at_s, records_of(scan)), 0.1 * i)
            bag.write("/odom", bag.odometry(wrong_s if i == 8 else 0.1 * i, T), 0.1 * i)
    drive = open_recording(bag.path)
    assert f"scans 5 ({T0_S + wrong_s:.3f} s)" in drive.note
    assert f"poses 8 ({T0_S + wrong_s:.3f} s)" in drive.note
    kept = [index for index in range(COUNT) if index != 5]
    np.testing.assert_allclose(drive.stamps, T0_S + 0.1 * np.array(kept))
    np.testing.assert_array_equal(drive.scan(5), SCANS[6])


def test_scans_received_at_once_are_distinguished(tmp_path):
    with Bag(tmp_path / "bag") as bag:
        for i, (scan, T) in enumerate(zip(SCANS, POSES, strict=True)):
            bag.write("/points", bag.cloud(0.1 * i, records_of(scan)), 0.2 * (i // 2))
            bag.write("/odom", bag.odometry(0.1 * i, T), 0.2 * (i // 2))
    drive = open_recording(bag.path)
    for index, scan in enumerate(SCANS):
        np.testing.assert_array_equal(drive.scan(index), scan)


def test_times_of_points_that_are_those_of_no_scan_are_not_used(tmp_path):
    with Bag(tmp_path / "bag") as bag:
        for i, (scan, T) in enumerate(zip(SCANS, POSES, strict=True)):
            records = records_of(scan, "Livox")
            records["timestamp"] = 1e9 * (T0_S + 0.1 * i) + 1e8 * np.linspace(0, 1, records.size)
            records["timestamp"][0, 0] = 0.0 if i == 0 else records["timestamp"][0, 0]
            bag.write("/points", bag.cloud(0.1 * i, records), 0.1 * i)
            bag.write("/odom", bag.odometry(0.1 * i, T), 0.1 * i)
    drive = open_recording(bag.path)
    assert "the times of the points (timestamp) span 1.7e+18" in drive.note
    assert drive.point_times_s(0) is None
    assert np.ptp(drive.point_times_s(1)) == pytest.approx(0.1, abs=0.01)


def test_a_bag_with_a_broken_message(tmp_path):
    with Bag(tmp_path / "bag") as bag:
        write_poses(bag)
        write_scans(bag)
    with sqlite3.connect(next(bag.path.glob("*.db3"))) as database:
        database.execute("UPDATE messages SET data = X'00010000' WHERE id = 5")
    with pytest.raises(ManycoreError, match="a broken bag"):
        open_recording(bag.path)
