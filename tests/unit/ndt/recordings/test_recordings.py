# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""Recordings other than bags: folders, poses, stamps in any unit."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

from rmw_manycore_py.errors import ManycoreError
from rmw_manycore_py.ndt.geometry.poses import from_xyz_rpy, inverse, to_quaternion
from rmw_manycore_py.ndt.maps.map_file import write_points
from rmw_manycore_py.ndt.recordings.opening import open_recording
from rmw_manycore_py.ndt.recordings.pose_file import read_poses
from rmw_manycore_py.ndt.recordings.recording import load_recording
from rmw_manycore_py.ndt.recordings.scan_folder import read_scan
from rmw_manycore_py.ndt.recordings.stamps import in_order, in_seconds

GENERATOR = np.random.default_rng(4)
SCANS = [GENERATOR.uniform(-20, 20, (50 + i, 3)).astype(np.float32) for i in range(12)]
POSES = np.stack([from_xyz_rpy((i, 0.1 * i, 0.0), (0.0, 0.0, 0.05 * i)) for i in range(12)])
T0_S = 1700000000.0


def kitti(poses: np.ndarray) -> str:
    return "\n".join(" ".join(map(str, T[:3].ravel())) for T in poses)


def tum(poses: np.ndarray, stamps: np.ndarray) -> str:
    rows = [[t, *T[:3, 3], *to_quaternion(T[:3, :3])] for t, T in zip(stamps, poses, strict=True)]
    return "# t x y z q\n" + "\n".join(" ".join(map(repr, map(float, row))) for row in rows)


def kitti_folder(folder: Path) -> Path:
    (folder / "velodyne").mkdir(parents=True)
    for i, scan in enumerate(SCANS):
        full = np.hstack([scan, np.ones((len(scan), 1), np.float32)])
        full.tofile(folder / "velodyne" / f"{i}.bin")
    return folder


def check(drive, poses=POSES) -> None:
    assert len(drive) == len(poses)
    np.testing.assert_allclose(drive.poses, poses, atol=1e-6)
    for index in (0, len(drive) - 1):
        np.testing.assert_allclose(drive.scan(index), SCANS[index], atol=1e-6)


def test_a_folder_as_kitti_has_it(tmp_path):
    """Scans sort in numeric order, and camera poses are transformed to the LiDAR."""
    T_camera_lidar = from_xyz_rpy((0.1, -0.3, 0.2), (1.5, 0.1, -1.4))
    folder = kitti_folder(tmp_path / "00")
    of_camera = T_camera_lidar @ POSES @ inverse(T_camera_lidar)
    (folder / "poses.txt").write_text(kitti(of_camera))
    (folder / "calib.txt").write_text("P0: 1 2\nTr: " + kitti(T_camera_lidar[None]))
    (folder / "times.txt").write_text("\n".join(f"{0.1 * i:e}" for i in range(12)))
    drive = open_recording(folder)
    check(drive)
    np.testing.assert_allclose(drive.times_s(), 0.1 * np.arange(12), atol=1e-9)


def test_scans_between_poses(tmp_path):
    """Poses at 20 Hz that begin late are interpolated, and earlier scans are dropped."""
    folder = kitti_folder(tmp_path / "drive")
    for i, path in enumerate(sorted(folder.rglob("*.bin"), key=lambda p: int(p.stem))):
        path.rename(path.with_name(f"{round(1e9 * T0_S) + i * 100_000_000}.bin"))
    half = np.stack([from_xyz_rpy((0.5 * i, 0.05 * i, 0), (0, 0, 0.025 * i)) for i in range(24)])
    stamps = T0_S + 0.02 + 0.05 * np.arange(24)
    (tmp_path / "other.txt").write_text(tum(half, stamps))
    drive = open_recording(folder, tmp_path / "other.txt")
    assert len(drive) == 11
    assert "1 of 12 scans have no pose" in drive.note
    np.testing.assert_allclose(drive.poses[0][0, 3], 0.8, atol=1e-3)
    np.testing.assert_allclose(drive.scan(0), SCANS[1])
    with pytest.raises(
        ManycoreError, match="without reference poses: name their file with --poses"
    ):
        open_recording(folder)


@pytest.mark.parametrize("suffix", [".pcd", ".ply", ".npy"])
def test_scans_of_other_kinds(tmp_path, suffix):
    """Points that are not finite, as in organised clouds, are dropped."""
    for i, scan in enumerate(SCANS):
        holes = np.vstack([scan, np.full((3, 3), np.nan, np.float32)])
        if suffix == ".npy":
            np.save(tmp_path / f"scan_{i}.npy", holes)
        else:
            write_points(tmp_path / f"scan_{i}{suffix}", holes)
    (tmp_path / "poses.txt").write_text(kitti(POSES))
    check(open_recording(tmp_path))


@pytest.mark.parametrize("kind", [np.uint64, np.uint32, np.int16, np.float64])
def test_stamps_of_any_type(kind):
    """Differences of unsigned integers must not wrap around."""
    np.testing.assert_allclose(in_seconds(np.array([1, 2, 4], kind)), [1.0, 2.0, 4.0])
    np.testing.assert_allclose(in_seconds(np.array([1, 4, 2], kind)), [1.0, 4.0, 2.0])


@pytest.mark.parametrize("seed", range(30))
def test_as_many_stamps_as_can_be_kept_increase(seed):
    stamps = np.random.default_rng(seed).integers(0, 12, 12).astype(float)
    lengths = [1] * len(stamps)  # of the longest sequence that ends at each stamp
    for late, early in ((b, a) for b in range(len(stamps)) for a in range(b)):
        if stamps[early] < stamps[late]:
            lengths[late] = max(lengths[late], lengths[early] + 1)
    kept = in_order(stamps)
    assert len(kept) == max(lengths)
    assert (np.diff(kept) > 0).all()
    assert (np.diff(stamps[kept]) > 0).all()


@pytest.mark.parametrize(
    ("changes", "lost"),
    [
        ({5: 0.4}, "scans 5 (0.400 s)"),  # twice: the first one stays
        ({5: 0.1}, "scans 5 (0.100 s)"),
        ({5: 1e6}, "scans 5 (1000000.000 s)"),
        ({0: 7e5, 3: 0.0, 7: 0.6, 9: 0.1}, "0 (700000.000 s), 3 (0.000 s), 7 (0.600 s) and 1 more"),
    ],
)
def test_a_scan_with_a_wrong_stamp_is_left_out_and_named(tmp_path, changes, lost):
    folder = kitti_folder(tmp_path / "drive")
    times_s = 0.1 * np.arange(len(SCANS))
    times_s[list(changes)] = list(changes.values())
    (folder / "poses.txt").write_text(kitti(POSES))
    (folder / "times.txt").write_text("".join(f"{time_s:.6f}\n" for time_s in times_s))
    drive = open_recording(folder)
    assert lost in drive.note
    kept = [index for index in range(len(SCANS)) if index not in changes]
    np.testing.assert_allclose(drive.stamps, times_s[kept])
    for place, index in enumerate(kept):
        np.testing.assert_allclose(drive.scan(place), SCANS[index])
        np.testing.assert_allclose(drive.poses[place], POSES[index], atol=1e-6)


def test_a_pose_with_a_wrong_stamp_is_left_out_and_named(tmp_path):
    folder = kitti_folder(tmp_path / "drive")
    stamps = 0.1 * np.arange(len(SCANS))
    wrong = stamps.copy()
    wrong[4] = 0.2
    (tmp_path / "poses.tum").write_text(tum(POSES, wrong))
    (folder / "times.txt").write_text("".join(f"{time_s:.6f}\n" for time_s in stamps))
    drive = open_recording(folder, tmp_path / "poses.tum")
    assert "poses 4 (0.200 s)" in drive.note
    np.testing.assert_allclose(drive.poses, POSES, atol=0.03)  # interpolated there


@pytest.mark.parametrize("unit_s", [1.0, 1e-3, 1e-6, 1e-9])
@pytest.mark.parametrize("start_s", [0.0, T0_S])
def test_stamps_in_any_unit(unit_s, start_s):
    stamps = np.rint((start_s + 0.5 * np.arange(5)) / unit_s * 2) / 2
    found = in_seconds(stamps if unit_s == 1.0 else stamps.astype(np.int64))
    np.testing.assert_allclose(found - found[0], 0.5 * np.arange(5), atol=1e-6)


def test_an_npz_of_other_arrays(tmp_path):
    """Without stamps, scale and note, with intensities, NaN, and poses of three rows."""
    points = np.hstack([np.concatenate(SCANS), np.ones((sum(map(len, SCANS)), 1))])
    points = np.vstack([points, [[np.nan, 0, 0, 0]]])
    offsets = np.cumsum([0, *map(len, SCANS)])
    offsets[-1] += 1
    np.savez(tmp_path / "a.npz", points=points, offsets=offsets, poses=POSES[:, :3])
    check(load_recording(tmp_path / "a.npz"))


@pytest.mark.parametrize(
    ("text", "words"),
    [
        ("", "found none"),
        ("1 2 3", "found 3 numbers"),
        ("1 2 3 4 5 6 7 8\n1 2", "pose 1 is '1 2'"),
        (kitti(POSES * 2), "pose 0 holds no rotation"),
        ("1 0 0 0 0 0 0 0", "a quaternion is zero"),
    ],
)
def test_poses_that_are_none(tmp_path, text, words):
    (tmp_path / "poses.txt").write_text(text)
    with pytest.raises(ManycoreError, match=words):
        read_poses(tmp_path / "poses.txt")


@pytest.mark.parametrize(
    ("array", "words"),
    [
        (None, "damaged or cut short"),
        (np.float32(1.0), "found the shape"),
        (np.zeros((4, 2), np.float32), "found the shape"),
        (np.array([None]), "holds Python objects"),
    ],
)
def test_arrays_that_are_no_scans(tmp_path, array, words):
    scan = tmp_path / "0.npy"
    scan.write_bytes(b"")
    if array is not None:
        np.save(scan, array)
    with pytest.raises(ManycoreError, match=rf"scan .*0\.npy: .*{words}"):
        read_scan(scan)


def test_times_that_are_none(tmp_path):
    folder = kitti_folder(tmp_path / "drive")
    (folder / "poses.txt").write_text(kitti(POSES))
    (folder / "times.txt").write_text("0.1\nnoon\n")
    with pytest.raises(ManycoreError, match="expected one time per line, found 'noon'"):
        open_recording(folder)


def test_folders_that_are_none(tmp_path):
    with pytest.raises(ManycoreError, match="no recording: expected scans as"):
        open_recording(tmp_path)
    folder = kitti_folder(tmp_path / "drive")
    (folder / "poses.txt").write_text(kitti(POSES[:5]))
    with pytest.raises(ManycoreError, match="12 scans, but 5 poses"):
        open_recording(folder)
    (folder / "poses.txt").write_text(tum(POSES, T0_S + np.arange(12)))
    (folder / "times.txt").write_text("\n".join(map(str, range(12))))
    with pytest.raises(ManycoreError, match="no scan has a pose near its time"):
        open_recording(folder)
    (folder / "velodyne" / "0.bin").write_bytes(b"12345")
    (folder / "times.txt").unlink()
    (folder / "poses.txt").write_text(kitti(POSES))
    with pytest.raises(ManycoreError, match=r"scan .*0\.bin: expected points of 16 bytes"):
        open_recording(folder).scan(0)
    (tmp_path / "broken.mcap").write_bytes(b"rubbish")
    with pytest.raises(ManycoreError, match="no bag"):
        open_recording(tmp_path / "broken.mcap")
