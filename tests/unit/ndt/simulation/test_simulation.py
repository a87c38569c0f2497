# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""The synthetic street: scans fit each other and the map, and the command writes them."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest
from click.testing import CliRunner

from rmw_manycore_py.cli.main import cli
from rmw_manycore_py.ndt import SerialMatcher, VoxelMap
from rmw_manycore_py.ndt.geometry.deskewing import deskewed
from rmw_manycore_py.ndt.geometry.poses import from_xyz_rpy, inverse, transform
from rmw_manycore_py.ndt.geometry.thinning import voxel_centroids
from rmw_manycore_py.ndt.maps.map_file import read_points
from rmw_manycore_py.ndt.maps.map_tiles import open_map
from rmw_manycore_py.ndt.recordings.recording import Recording, load_recording, save_recording
from rmw_manycore_py.ndt.simulation.drive import drive_poses
from rmw_manycore_py.ndt.simulation.lidar import Lidar
from rmw_manycore_py.ndt.simulation.street import Street, build_street

pytestmark = pytest.mark.unit

EMPTY_ROAD = {
    "lower": np.zeros((0, 3)),
    "upper": np.zeros((0, 3)),
    "centres": np.zeros((0, 2)),
    "radii": np.zeros(0),
    "heights": np.zeros(0),
}
EXACT = Lidar(rings=16, azimuths=360, noise_m=0.0)


def seen(street: Street, position: tuple[float, float, float] = (0.0, 0.0, 2.0)) -> np.ndarray:
    pose = from_xyz_rpy(position, (0.1, -0.1, 0.7))
    return transform(pose, EXACT.scan(street, pose, np.random.default_rng(0)))


def test_the_ground_is_flat():
    points = seen(Street(**EMPTY_ROAD))
    assert len(points) > 1000
    np.testing.assert_allclose(points[:, 2], 0.0, atol=1e-4)


def test_a_wall_hides_what_is_behind_it():
    corners = {"lower": np.array([[5.0, -50, 0]]), "upper": np.array([[6.0, 50, 9]])}
    points = seen(Street(**{**EMPTY_ROAD, **corners}))
    assert points[:, 0].max() < 5.0 + 1e-4
    assert (np.abs(points[:, 0] - 5.0) < 1e-4).sum() > 500


def test_a_pole_is_round():
    pole = {"centres": np.array([[4.0, 0.0]]), "radii": np.ones(1), "heights": np.array([5.0])}
    points = seen(Street(**{**EMPTY_ROAD, **pole}))
    on_pole = points[points[:, 2] > 1e-3]
    assert len(on_pole) > 100
    np.testing.assert_allclose(np.hypot(on_pole[:, 0] - 4.0, on_pole[:, 1]), 1.0, atol=1e-4)
    assert on_pole[:, 2].max() < 5.0


def test_a_street_is_the_same_for_the_same_seed():
    one, same, other = (build_street(50.0, np.random.default_rng(seed)) for seed in (1, 1, 2))
    np.testing.assert_array_equal(one.lower, same.lower)
    assert one.lower.shape != other.lower.shape or not np.array_equal(one.lower, other.lower)


def test_a_drive_keeps_its_speed():
    poses, stamps = drive_poses(40.0, 8.0)
    steps = np.linalg.norm(np.diff(poses[:, :3, 3], axis=0), axis=1)
    np.testing.assert_allclose(steps, 0.8, atol=0.01)
    np.testing.assert_allclose(np.diff(stamps), 0.1)


def test_the_command(tmp_path):
    """Scans lie on the map without being copies of it; tiles contain all of the map's points."""
    street = tmp_path / "street"
    runner = CliRunner()
    result = runner.invoke(cli, ["ndt", "simulate", str(street), "--length", "6"])
    assert result.exit_code == 0, result.output
    drive, points = load_recording(street / "drive.npz"), read_points(street / "map.npz")
    assert len(drive) == 7
    scan = drive.accumulated([3])
    cells = {tuple(cell) for cell in np.floor(points / 0.4).astype(int)}
    on_map = np.mean([tuple(cell) in cells for cell in np.floor(scan / 0.4).astype(int)])
    assert on_map > 0.8
    arguments = ["--tile-size", "20", "--format", "npz", "--leaf", "0.3"]
    tiles = tmp_path / "tiles"
    drive_file = str(street / "drive.npz")
    result = runner.invoke(cli, ["ndt", "map", drive_file, "-o", str(tiles), *arguments])
    assert result.exit_code == 0, result.output
    _, loaded = open_map(tiles).around(0.0, 0.0, 1e4)
    assert len(loaded) == len(voxel_centroids(drive.accumulated(range(7)), (0.3, 0.3, 0.3)))


def drive_in(directory: Path) -> Path:
    scan = np.random.default_rng(1).uniform(-5, 5, (100, 3))
    poses = np.stack([np.eye(4), np.eye(4)])
    save_recording(directory / "drive.npz", Recording([scan, scan], poses, np.zeros(0)))
    return directory / "drive.npz"


@pytest.mark.parametrize(
    ("arguments", "status", "words"),
    [
        (["map", "drive.npz", "-o", "map.npz", "--leaf", "1e-9"], 2, "are too small for a cloud"),
        (["map", "drive.npz", "-o", "drive.npz/map.npz"], 2, "no directory 'drive.npz'"),
        (["map", "drive.npz", "-o", "none/map.npz"], 2, "there is no directory 'none'"),
        (["map", "drive.npz", "-o", "a" * 300 + ".npz"], 1, "File name too long"),
        (["map", "drive.npz", "-o", "drive.npz/tiles", "--tile-size", "20"], 2, "no directory"),
        (["simulate", "drive.npz/street"], 1, "cannot be written: "),
        (["replay", "drive.npz", "--csv", "none/x.csv"], 2, "there is no directory 'none'"),
        (["replay", "drive.npz", "--plot", "none/x.png"], 2, "there is no directory 'none'"),
        (["replay", "drive.npz", "--plot", "x.foo"], 2, "a file that ends in .png, .svg, .pdf"),
        (["replay", "drive.npz", "--csv", "."], 2, "is a directory"),
    ],
)
def test_files_that_cannot_be_written(tmp_path, monkeypatch, arguments, status, words):
    drive_in(tmp_path)
    monkeypatch.chdir(tmp_path)
    result = CliRunner().invoke(cli, ["ndt", *arguments])
    assert result.exit_code == status
    assert words in result.output
    assert "Traceback" not in result.output


def test_the_command_reports_problems(tmp_path):
    (tmp_path / "drive.npz").write_bytes(b"rubbish")
    arguments = ["ndt", "map", str(tmp_path / "drive.npz"), "-o", str(tmp_path / "map.npz")]
    result = CliRunner().invoke(cli, arguments)
    assert result.exit_code == 2
    assert "no recording" in result.output


def simulated(directory: Path, *options: str) -> Recording:
    """Return a drive of two scans, and check that the command wrote it."""
    arguments = ["ndt", "simulate", str(directory), "--length", "5", "--speed", "20"]
    result = CliRunner().invoke(cli, [*arguments, "--azimuths", "90", "--beams", "8", *options])
    assert result.exit_code == 0, result.output
    return load_recording(directory / "drive.npz")


def test_what_is_known_of_the_sensor_and_the_road_can_be_chosen(tmp_path):
    near = simulated(tmp_path / "near", "--range", "20").scan(1)
    assert 15.0 < np.linalg.norm(near, axis=1).max() < 20.5

    hidden = simulated(tmp_path / "hidden", "--occlusion", "0.5").scan(1)
    assert np.abs(np.degrees(np.arctan2(hidden[:, 1], hidden[:, 0]))).max() < 92.0

    exact = simulated(tmp_path / "exact", "--noise", "0", "--traffic", "4")
    assert exact.point_times_s(1) is None
    ahead = exact.scan(1)
    on_road = (np.abs(ahead[:, 1]) < 1.0) & (ahead[:, 2] > -1.4) & (np.abs(ahead[:, 0]) < 15.0)
    assert on_road.any()
    empty = simulated(tmp_path / "empty", "--noise", "0").scan(1)
    assert not (
        (np.abs(empty[:, 1]) < 1.0) & (empty[:, 2] > -1.4) & (np.abs(empty[:, 0]) < 15.0)
    ).any()


def test_a_scan_taken_while_driving_is_deskewed_by_its_times(tmp_path):
    """Only the deskewed scan fits the map of a standing LiDAR at the pose of its stamp."""
    finer = ("--azimuths", "240", "--beams", "16", "--distortion")
    drive = simulated(tmp_path / "moving", *finer)
    times_s = drive.point_times_s(1)
    assert times_s is not None
    assert (times_s.min() > 0.0) & (times_s.max() < 0.1)
    matcher = SerialMatcher()
    matcher.set_map(VoxelMap.from_points(read_points(tmp_path / "moving" / "map.npz")))
    motion = inverse(drive.poses[1]) @ drive_poses(9.0, 20.0)[0][2]
    likelihoods = [
        matcher.score(points, drive.poses[1]).nearest_voxel_likelihood
        for points in (drive.scan(1), deskewed(drive.scan(1), times_s / 0.1, motion))
    ]
    assert likelihoods[0] + 0.2 < likelihoods[1]
