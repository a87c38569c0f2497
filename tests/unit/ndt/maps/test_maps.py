# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""Recordings and maps in files: round trips, downsampling, tiles, and many kinds of damage."""

from __future__ import annotations

import zipfile
from contextlib import suppress
from pathlib import Path

import numpy as np
import pytest

from rmw_manycore_py.errors import EXIT_BAD_INPUT, ManycoreError
from rmw_manycore_py.ndt.geometry.poses import from_xyz_rpy
from rmw_manycore_py.ndt.geometry.precision import needs_doubles, why_coarse
from rmw_manycore_py.ndt.geometry.thinning import voxel_centroids
from rmw_manycore_py.ndt.maps.map_file import read_points, write_points
from rmw_manycore_py.ndt.maps.map_tiles import METADATA, TileFiles, open_map, write_tiles
from rmw_manycore_py.ndt.recordings.recording import Recording, load_recording, save_recording
from rmw_manycore_py.ndt.recordings.scan_folder import read_scan
from support.nodes.scan_matching import write_boastful_npz

pytestmark = pytest.mark.unit

needs_open3d = pytest.mark.needs("open3d")
FORMATS = [".npz", ".pcd", ".ply"]


def cloud(count: int = 5000) -> np.ndarray:
    points = np.random.default_rng(1).uniform((-40, -20, 0), (60, 30, 8), (count, 3))
    return points.astype(np.float32)


UTM_M = np.array([500_000.0, 5_000_000.0, 100.0])


def in_order(points: np.ndarray) -> np.ndarray:
    return points[np.lexsort(np.rint(points * 100).T)]


@pytest.mark.parametrize("suffix", FORMATS)
def test_a_map_there_and_back(tmp_path, suffix):
    points = cloud()
    write_points(tmp_path / f"map{suffix}", points)
    np.testing.assert_array_equal(read_points(tmp_path / f"map{suffix}"), points)


@pytest.mark.parametrize("suffix", FORMATS)
def test_a_map_in_utm_coordinates_there_and_back(tmp_path, suffix):
    """Single precision has steps of half a metre there, so points stay doubles, also in tiles."""
    points = cloud().astype(np.float64) + UTM_M
    write_points(tmp_path / f"map{suffix}", points)
    np.testing.assert_array_equal(read_points(tmp_path / f"map{suffix}"), points)
    write_tiles(tmp_path / "tiles", points, 20.0, suffix)
    near = open_map(tmp_path / "tiles").around(*UTM_M[:2], 5.0)[1]
    assert len(near)
    assert set(map(tuple, near)) <= set(map(tuple, points))


@needs_open3d
def test_a_map_in_utm_coordinates_is_thinned_as_at_the_origin(tmp_path):
    points = cloud(50000).astype(np.float64)
    write_points(tmp_path / "here.pcd", points)
    write_points(tmp_path / "there.pcd", points + UTM_M)
    here, there = (read_points(tmp_path / f"{name}.pcd", 5.0) for name in ("here", "there"))
    np.testing.assert_allclose(in_order(there - UTM_M), in_order(here), atol=1e-3)
    np.testing.assert_allclose(
        in_order(voxel_centroids(points + UTM_M, (5.0,) * 3) - UTM_M),
        in_order(voxel_centroids(points, (5.0,) * 3)),
        atol=1e-6,
    )


def test_maps_that_single_precision_has_spoiled(tmp_path):
    """They are read, and a warning states the lost precision; maps of the usual size get none."""
    near, far = cloud(), (cloud() + UTM_M).astype(np.float32)
    assert why_coarse(near) == ""
    assert why_coarse(far.astype(np.float64)) == ""
    write_points(tmp_path / "far.npz", far)
    assert why_coarse(read_points(tmp_path / "far.npz"))
    write_points(tmp_path / "far.pcd", far)
    assert b"SIZE 4 4 4" in (tmp_path / "far.pcd").read_bytes()[:300]
    assert "knows only every 0.5 m there: give them as doubles" in why_coarse(
        read_points(tmp_path / "far.pcd")
    )
    for points in (near.astype(np.float64), -near, near[:0], np.full((5, 3), np.nan)):
        assert not needs_doubles(points)
    assert needs_doubles(np.array([[0.0, np.nan, -40000.0]]))


@needs_open3d
def test_maps_are_thinned_as_scans_are(tmp_path):
    """Open3D centres its first voxel on the lower corner of the cloud."""
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
    with pytest.raises(ManycoreError, match="too small"):
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
    assert names == frozenset(tiles.files_around(30.0, 10.0, 5.0).paths)
    assert near[:, 0].min() > 19.9
    assert near[:, 0].max() < 40.1
    names, nothing = tiles.around(5000.0, 0.0, 100.0)
    assert (names, nothing.shape) == (frozenset(), (0, 3))


def test_tiles_are_kept_until_others_are_read(tmp_path):
    first, second = (TileFiles((tmp_path / f"{name}.npz",), 0.0) for name in "ab")
    for files in (first, second):
        write_points(files.paths[0], cloud())
    loaded = {}
    first.read(loaded)
    first.paths[0].unlink()
    assert len(first.read(loaded)) == 5000
    second.read(loaded)
    assert list(loaded) == list(second.paths)


def test_a_single_file_is_everywhere(tmp_path):
    write_points(tmp_path / "map.npz", cloud())
    assert len(open_map(tmp_path / "map.npz").around(1e6, 1e6, 1.0)[1]) == 5000


ASCII_PLY = b"ply\nformat ascii 1.0\nelement vertex 2\n" + b"".join(
    f"property float {axis}\n".encode() for axis in "xyz"
)
ASCII_PLY += b"end_header\n"


@pytest.mark.parametrize(
    ("name", "content", "words"),
    [
        ("map.npz", None, "no such file"),
        ("map.las", b"", "ends in .pcd, .ply, .npz"),
        ("map.npz", b"PK\3\4 broken", "cannot be read as npz: it is damaged or cut short"),
        ("map.npz", b"", "cannot be read as npz: it is damaged or cut short"),
        ("map.pcd", b"# .PCD v0.7\nrubbish", "DATA, found 'rubbish'"),
        ("map.pcd", b"", "its header is broken: it has no line DATA"),
        ("map.ply", b"ply\nrubbish", "expected an element or a property, found 'rubbish'"),
        ("map.ply", b"ply\nelement\nend_header\n", "its header is broken: it ends early"),
        ("map.ply", b"ply\nelement vertex x\nend_header\n", "a count is not a number: 'x'"),
        ("map.ply", b"ply\nformat ascii 1.0\nend_header\n", "no points"),
        ("map.ply", b"ply\nformat ascii 1.0\n", "no points"),
        ("map.ply", ASCII_PLY + b"1 2 3\na b c\n", "expected numbers in line 9, found 'a'"),
        ("map.ply", ASCII_PLY + b"1 2 3\n4 \xff 6\n", "expected numbers in line 9, found"),
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


@pytest.mark.parametrize("place", range(0, 300, 7))
def test_damaged_npz_files(tmp_path, place):
    """Whatever the damage, the error names the file; a few kinds of damage do not matter."""
    path = tmp_path / "map.npz"
    write_points(path, cloud(20))
    damaged = bytearray(path.read_bytes())
    damaged[place : place + 3] = np.random.default_rng(place).bytes(3)
    path.write_bytes(damaged)
    with suppress(ManycoreError):
        read_points(path)
    damaged[30:90] = bytes(range(60))
    path.write_bytes(damaged)
    with pytest.raises(ManycoreError, match=r"map\.npz"):
        read_points(path)


@pytest.mark.parametrize(
    ("member", "words"),
    [
        (b"rubbish", "points are not"),
        (b"\x93NUMPY\1\0\x0e\0{'shape': (1,,\n", "cannot be read as npz"),
        (b"\x93NUMPY\1\0\x0e\0{'shape': ((((\n", "cannot be read as npz"),
    ],
)
def test_npz_files_of_damaged_arrays(tmp_path, member, words):
    path = tmp_path / "map.npz"
    np.savez(path, offsets=[0, 1], poses=np.eye(4)[None])
    with zipfile.ZipFile(path, "a") as file:
        file.writestr("points.npy", member)
    with pytest.raises(ManycoreError, match=rf"map\.npz: .*{words}"):
        read_points(path)


def test_a_map_that_announces_more_than_there_is(tmp_path):
    write_boastful_npz(tmp_path / "map.npz")
    with pytest.raises(ManycoreError, match=r"map\.npz: .*it announces more data than memory"):
        read_points(tmp_path / "map.npz")
    with (tmp_path / "scan.npy").open("wb") as file:
        header = {"descr": "<f4", "fortran_order": False, "shape": (1 << 48, 3)}
        np.lib.format.write_array_header_1_0(file, header)
    with pytest.raises(ManycoreError, match=r"scan\.npy: .{10}"):
        read_scan(tmp_path / "scan.npy")


@needs_open3d
def test_a_map_that_cannot_be_thinned_so_finely(tmp_path):
    write_points(tmp_path / "map.npz", cloud())
    with pytest.raises(ManycoreError, match=r"map\.npz: it cannot be downsampled to 1e-09 m"):
        read_points(tmp_path / "map.npz", 1e-9)


def test_maps_that_the_system_refuses(tmp_path):
    with pytest.raises(ManycoreError, match="File name too long"):
        open_map(tmp_path / ("a" * 300))


HEADER = (
    "ply\nformat {}\ncomment made by hand\nelement vertex 3\nproperty {} x\nproperty {} y\n"
    "property {} z\nproperty uchar red\nelement face 0\nproperty list uchar int vertex_indices\n"
    "end_header\n"
)
CORNERS = [[1.0, 2.0, 3.0], [-4.0, 5.0, 6.5], [7.0, 8.0, 5_000_000.25]]


@pytest.mark.parametrize("number", ["float", "double", "float64"])
@pytest.mark.parametrize("encoding", ["ascii", "binary_little_endian", "binary_big_endian"])
def test_ply_files_whole_and_cut_off(tmp_path, encoding, number):
    path = tmp_path / "map.ply"
    if encoding == "ascii":
        data = "".join(f"{x} {y} {z} 9\n" for x, y, z in CORNERS).encode()
    else:
        kind = (">" if "big" in encoding else "<") + ("f4" if number == "float" else "f8")
        records = np.zeros(3, [*((axis, kind) for axis in "xyz"), ("red", "u1")])
        for axis, values in zip("xyz", np.transpose(CORNERS), strict=True):
            records[axis] = values
        data = records.tobytes()
    header = HEADER.format(f"{encoding} 1.0", *[number] * 3).encode()
    path.write_bytes(header + data)
    np.testing.assert_allclose(read_points(path), CORNERS, atol=0.3 if number == "float" else 0.0)
    assert read_points(path).dtype == (np.float32 if number == "float" else np.float64)
    path.write_bytes(header + data[: len(data) // 2])
    with pytest.raises(ManycoreError, match=r"its 3 points need \d+ (numbers|bytes), found"):
        read_points(path)


def test_a_text_on_one_line_and_a_name_in_capitals(tmp_path):
    header = " ".join(HEADER.format("ascii 1.0", *["double"] * 3).split("\n"))
    header = header.replace("comment made by hand", "")
    data = " ".join(f"{x} {y} {z} 9" for x, y, z in CORNERS)
    (tmp_path / "MAP.PLY").write_text(header + data)
    np.testing.assert_array_equal(read_points(tmp_path / "MAP.PLY"), CORNERS)
    assert [tile.path.name for tile in open_map(tmp_path).tiles] == ["MAP.PLY"]


def test_axes_in_another_order(tmp_path):
    """Open3D (0.20) mixes them up."""
    header = HEADER.format("ascii 1.0", *["double"] * 3)
    header = header.replace("double x", "double a").replace("double z", "double x")
    data = "".join(f"{z} {y} {x} 9\n" for x, y, z in CORNERS)
    (tmp_path / "map.ply").write_text(header.replace("double a", "double z") + data)
    np.testing.assert_array_equal(read_points(tmp_path / "map.ply"), CORNERS)


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
        ("x: [", "expected x_resolution.* found no valid YAML in line 1$"),
        ("y_resolution: 20", "expected x_resolution.* found no key 'x_resolution'$"),
    ],
)
def test_broken_folders(tmp_path, text, words):
    with pytest.raises(ManycoreError, match=words):
        open_map(folder_with(tmp_path, text))


def test_scans_are_accumulated_far_from_the_origin(tmp_path):
    """Poses are doubles, and so are the points transformed by them."""
    T = from_xyz_rpy(UTM_M, (0.0, 0.0, 0.5))
    save_recording(tmp_path / "drive.npz", Recording([cloud(100) / 2], T[None], np.zeros(0)))
    drive = load_recording(tmp_path / "drive.npz")
    expected = drive.scan(0).astype(np.float64) @ T[:3, :3].T + UTM_M
    np.testing.assert_allclose(drive.accumulated([0]), expected, atol=1e-6)
    np.testing.assert_array_equal(read_points(tmp_path / "drive.npz"), drive.accumulated([0]))


def test_whole_numbers_of_millimetres(tmp_path):
    millimetres = np.array([[500_000_001, 5_000_000 * 1000 + 3, 100_000]], np.int64)
    arrays = {"points": millimetres, "scale_m": 0.001, "offsets": [0, 1], "poses": np.eye(4)[None]}
    np.savez(tmp_path / "map.npz", **arrays)
    found = read_points(tmp_path / "map.npz")
    np.testing.assert_allclose(found, [[500_000.001, 5_000_000.003, 100.0]], atol=1e-6)


@pytest.mark.parametrize("scale", [{}, {"scale_m": 0.5}])
def test_an_npz_file_of_points_alone_is_a_map(tmp_path, scale):
    points = cloud(100)
    points[7, 1] = np.nan
    np.savez(tmp_path / "map.npz", points=points, **scale)
    expected = np.delete(points, 7, axis=0) * np.float32(scale.get("scale_m", 1.0))
    np.testing.assert_array_equal(read_points(tmp_path / "map.npz"), expected)


@pytest.mark.parametrize(
    ("arrays", "words"),
    [
        ({"cats": np.zeros(3)}, "it has no array offsets, points, poses: expected points"),
        ({"points": np.zeros((5, 3)), "poses": np.eye(4)[None]}, "it has no array offsets: exp"),
        ({"points": np.zeros(15)}, "points are not"),
        ({"points": np.float32(1.0)}, "points are not"),
        ({"points": np.zeros((0, 3))}, "it has no points"),
    ],
)
def test_npz_files_that_are_no_maps(tmp_path, arrays, words):
    np.savez(tmp_path / "map.npz", **arrays)
    with pytest.raises(ManycoreError, match=rf"map\.npz: .*{words}"):
        read_points(tmp_path / "map.npz")


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
