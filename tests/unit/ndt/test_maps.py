# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""Recordings and maps in files: there and back, thinned, in tiles, and broken in many ways."""

from __future__ import annotations

import importlib.util
from pathlib import Path

import numpy as np
import pytest

from rmw_manycore_py.errors import EXIT_BAD_INPUT, ManycoreError
from rmw_manycore_py.ndt.map_file import read_points, write_points
from rmw_manycore_py.ndt.map_tiles import METADATA, open_map, write_tiles
from rmw_manycore_py.ndt.poses import from_xyz_rpy
from rmw_manycore_py.ndt.recording import Recording, load_recording, save_recording
from rmw_manycore_py.ndt.thinning import voxel_centroids

pytestmark = pytest.mark.unit

needs_open3d = pytest.mark.skipif(
    importlib.util.find_spec("open3d") is None, reason="needs the extra ndt (Open3D)"
)
FORMATS = [
    ".npz",
    pytest.param(".pcd", marks=needs_open3d),
    pytest.param(".ply", marks=needs_open3d),
]


def cloud(count: int = 5000) -> np.ndarray:
    points = np.random.default_rng(1).uniform((-40, -20, 0), (60, 30, 8), (count, 3))
    return points.astype(np.float32)


def in_order(points: np.ndarray) -> np.ndarray:
    return points[np.lexsort(np.rint(points * 100).T)]


@pytest.mark.parametrize("suffix", FORMATS)
def test_a_map_there_and_back(tmp_path, suffix):
    points = cloud()
    write_points(tmp_path / f"map{suffix}", points)
    np.testing.assert_allclose(read_points(tmp_path / f"map{suffix}"), points, atol=0.002)


@needs_open3d
def test_maps_are_thinned_as_scans_are(tmp_path):
    """Open3D's first voxel is centred on the lower corner of the cloud."""
    points = cloud(50000)
    write_points(tmp_path / "map.pcd", points)
    thinned = read_points(tmp_path / "map.pcd", leaf_m=5.0)
    corner = points.min(axis=0) - np.float32(2.5)
    ours = voxel_centroids(points - corner, (5.0, 5.0, 5.0)) + corner
    assert len(thinned) == len(ours)
    np.testing.assert_allclose(in_order(thinned), in_order(ours), atol=1e-3)


def test_one_centroid_per_voxel():
    points = np.array([[0.1, 0, 0], [0.3, 0, 0], [0.9, 0, 0], [-0.1, 0, 0]], np.float32)
    thinned = voxel_centroids(points, (0.5, 0.5, 0.5))
    np.testing.assert_allclose(np.sort(thinned[:, 0]), [-0.1, 0.2, 0.9], atol=1e-6)
    assert voxel_centroids(points[:0], (0.5, 0.5, 0.5)).shape == (0, 3)
    with pytest.raises(ValueError, match="too small"):
        voxel_centroids(cloud() * np.float32(1e12), (1e-6, 1e-6, 1e-6))


@pytest.mark.parametrize("suffix", FORMATS)
@pytest.mark.parametrize("with_metadata", [True, False])
def test_tiles_around_a_place(tmp_path, suffix, with_metadata):
    points = cloud()
    assert write_tiles(tmp_path / "tiles", points, 20.0, suffix) == 5 * 3
    if not with_metadata:
        (tmp_path / "tiles" / METADATA).unlink()
    tiles = open_map(tmp_path / "tiles")
    _, everything = tiles.around(0.0, 0.0, 1000.0)
    assert len(everything) == len(points)
    names, near = tiles.around(30.0, 10.0, 5.0)
    assert {path.stem for path in names} == {"1_0"}
    assert names == tiles.names_around(30.0, 10.0, 5.0)
    assert near[:, 0].min() > 19.9
    assert near[:, 0].max() < 40.1
    names, nothing = tiles.around(5000.0, 0.0, 100.0)
    assert (names, nothing.shape) == (frozenset(), (0, 3))


def test_a_single_file_is_everywhere(tmp_path):
    write_points(tmp_path / "map.npz", cloud())
    assert len(open_map(tmp_path / "map.npz").around(1e6, 1e6, 1.0)[1]) == 5000


@pytest.mark.parametrize(
    ("name", "content", "words"),
    [
        ("map.npz", None, "no such file"),
        ("map.las", b"", "ends in .pcd, .ply, .npz"),
        ("map.npz", b"PK\3\4 broken", "cannot be read as npz"),
        ("map.npz", b"", "cannot be read as npz"),
        pytest.param("map.pcd", b"# .PCD v0.7\nrubbish", "no points", marks=needs_open3d),
        pytest.param("map.pcd", b"", "no points", marks=needs_open3d),
        pytest.param("map.ply", b"ply\nrubbish", "no points", marks=needs_open3d),
    ],
)
def test_broken_maps(tmp_path, name, content, words):
    path = tmp_path / name
    if content is not None:
        path.write_bytes(content)
    with pytest.raises(ManycoreError, match=words) as caught:
        read_points(path)
    assert caught.value.exit_status == EXIT_BAD_INPUT
    assert str(path) in str(caught.value)


def folder_with(tmp_path: Path, text: str | None) -> Path:
    folder = tmp_path / "tiles"
    folder.mkdir()
    if text is not None:
        (folder / METADATA).write_text(text)
    return folder


@pytest.mark.parametrize(
    ("text", "words"),
    [
        (None, "no PCD, PLY or npz file"),
        ("x_resolution: 20", "expected x_resolution"),
        ("[1, 2]", "expected x_resolution"),
        ("x_resolution: 1\ny_resolution: 1\na.pcd: [0, 0]", "tile a.pcd is missing"),
        ("x: [", "expected x_resolution"),
    ],
)
def test_broken_folders(tmp_path, text, words):
    with pytest.raises(ManycoreError, match=words):
        open_map(folder_with(tmp_path, text))


def test_a_recording_there_and_back(tmp_path):
    scans = [cloud(100) / 2, cloud(50) / 2]
    two = np.stack([np.eye(4), from_xyz_rpy((1, 2, 3))])
    made = Recording(scans, two, np.array([5.0, 5.5]), "a note")
    save_recording(tmp_path / "drive.npz", made)
    drive = load_recording(tmp_path / "drive.npz")
    assert (len(drive), drive.note) == (2, "a note")
    np.testing.assert_allclose(drive.scan(1), scans[1], atol=0.002)
    np.testing.assert_allclose(drive.times_s(), [0.0, 0.5])
    np.testing.assert_allclose(drive.accumulated([1]), scans[1] + np.float32([1, 2, 3]), atol=0.002)
    with pytest.raises(ValueError, match="larger scale_m"):
        save_recording(tmp_path / "far.npz", Recording([cloud() * 10], two[:1], np.zeros(0)))


@pytest.mark.parametrize(
    ("change", "words"),
    [
        ({"offsets": None}, "no array offsets"),
        ({"points": np.zeros((3, 2), np.int16)}, "points are not"),
        ({"poses": np.full((1, 4, 4), np.nan)}, "not finite"),
        ({"poses": np.eye(4)}, "poses are not"),
        ({"offsets": np.array([0])}, "one more than poses"),
        ({"offsets": np.array([0, 99])}, "do not increase within points"),
        ({"scale_m": -1.0}, "scale_m"),
        ({"stamps": np.array([1.0, 2.0])}, "one per pose"),
    ],
)
def test_broken_recordings(tmp_path, change, words):
    arrays = {
        "points": np.zeros((5, 3), np.int16),
        "offsets": np.array([0, 5]),
        "poses": np.eye(4)[None],
        **change,
    }
    np.savez(tmp_path / "drive.npz", **{k: v for k, v in arrays.items() if v is not None})
    with pytest.raises(ManycoreError, match=words):
        load_recording(tmp_path / "drive.npz")
