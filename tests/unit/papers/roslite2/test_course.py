# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""Courses: free of obstacles, consistent with the LiDAR, and equal after a round trip to files."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest
from click.testing import CliRunner

from rmw_manycore_py.cli.main import cli
from rmw_manycore_py.errors import ManycoreError
from rmw_manycore_py.ndt.geometry.poses import from_xyz_rpy
from rmw_manycore_py.ndt.maps.map_file import write_points
from rmw_manycore_py.papers.roslite2.course.directory import (
    Course,
    mapped,
    read_course,
    thinned,
    write_course,
)
from rmw_manycore_py.papers.roslite2.course.shape import CourseShape
from rmw_manycore_py.papers.roslite2.course.streets import CLEARANCE_M, build_streets, near
from rmw_manycore_py.papers.roslite2.course.trajectory_file import write_trajectory
from rmw_manycore_py.papers.roslite2.course.views import (
    LIDAR,
    SENSOR_HEIGHT_M,
    PointView,
    StreetView,
)

pytestmark = pytest.mark.unit

SHAPE = CourseShape(40.0, 5.0)


@pytest.fixture(scope="module")
def course() -> Course:
    generator = np.random.default_rng(1)
    way = SHAPE.trajectory()
    view = StreetView(build_streets(SHAPE, way, generator))
    return Course(way, thinned(mapped(view, way, generator)), view)


def manycore(*arguments: object) -> tuple[int, str]:
    result = CliRunner().invoke(cli, ["whill", "course", *map(str, arguments)])
    return result.exit_code, result.output


def test_nothing_stands_in_the_way(course):
    street = course.view.street
    for x, y in zip(course.trajectory.x_m, course.trajectory.y_m, strict=True):
        nearest = np.clip((x, y), street.lower[:, :2], street.upper[:, :2])
        assert np.linalg.norm(nearest - (x, y), axis=1).min() > CLEARANCE_M
        away = np.linalg.norm(street.centres - (x, y), axis=1) - street.radii
        assert away.min() > CLEARANCE_M
    assert len(street.lower) > 50


def test_what_is_left_out_of_a_scan_is_out_of_reach(course):
    street, pose = course.view.street, from_xyz_rpy((20.0, 5.0, 1.2), (0.0, 0.0, 0.7))
    selected = near(street, 20.0, 5.0, LIDAR.range_m)
    assert len(selected.lower) <= len(street.lower)
    scans = [LIDAR.scan(one, pose, np.random.default_rng(3)) for one in (street, selected)]
    np.testing.assert_array_equal(*scans)


def test_a_scan_stands_on_the_ground(course):
    scan = course.view.scan(0.0, 0.0, 0.0, np.random.default_rng(1))
    assert np.percentile(scan[:, 2], 2) == pytest.approx(0.0, abs=0.1)
    assert scan[:, 2].max() > SENSOR_HEIGHT_M


def test_a_map_of_points_is_seen_as_the_streets_are(course):
    """Every ray ends at a point of the map; near surfaces have the same distance in both."""
    place = (3.0, 0.0, 0.1)
    by_points = PointView(course.map_points).scan(*place, np.random.default_rng(1))
    by_streets = course.view.scan(*place, np.random.default_rng(1))
    assert len(by_points) > 0.5 * len(by_streets)

    def distances(scan):
        """Return the distance of the nearest upright surface in each of 16 directions."""
        upright = scan[(scan[:, 2] > 0.5) & (scan[:, 2] < 2.0)]
        part = ((np.arctan2(upright[:, 1], upright[:, 0]) + np.pi) * 8 / np.pi).astype(int) % 16
        ranges = np.hypot(upright[:, 0], upright[:, 1])
        return np.array([ranges[part == one].min(initial=40.0) for one in range(16)])

    assert np.median(np.abs(distances(by_points) - distances(by_streets))) < 0.3


def test_files_there_and_back(course, tmp_path):
    (tmp_path / "mapfile").touch()
    write_course(tmp_path, course, tmp_path / "mapfile")
    back = read_course(tmp_path)
    assert len(back.trajectory) == len(course.trajectory)
    np.testing.assert_array_equal(back.view.street.lower, course.view.street.lower)
    np.testing.assert_allclose(back.map_points, course.map_points, atol=1e-4)


def test_a_map_of_ones_own(course, tmp_path):
    write_points(tmp_path / "my.pcd", course.map_points)
    write_trajectory(tmp_path / "my.csv", course.trajectory)
    own = ("--map", tmp_path / "my.pcd", "--trajectory", tmp_path / "my.csv")
    status, output = manycore(tmp_path / "course", *own)
    assert status == 0, output
    assert isinstance(read_course(tmp_path / "course").view, PointView)


def test_a_course_outside_the_map(course, tmp_path):
    write_points(tmp_path / "my.npz", course.map_points)
    way = CourseShape(120.0, 5.0).trajectory()
    write_trajectory(tmp_path / "my.csv", way)
    own = ("--map", tmp_path / "my.npz", "--trajectory", tmp_path / "my.csv")
    status, output = manycore(tmp_path / "course", *own)
    assert status == 2
    assert "my.csv:" in output
    assert "expected a course inside the map" in output


@pytest.mark.parametrize(
    ("options", "said"),
    [
        (("--length", "30"), "expected at least 62 m; or give a smaller --turn-radius"),
        (("--map", "MAP"), "--map and --trajectory require each other"),
        (("--speed", "3"), "3.0 is not in the range"),
    ],
)
def test_wrong_options(tmp_path, options, said):
    (tmp_path / "map").touch()
    words = [str(tmp_path / "map") if word == "MAP" else word for word in options]
    status, output = manycore(tmp_path / "course", *words)
    assert status == 2
    assert said in " ".join(output.split())


def test_no_course(tmp_path):
    with pytest.raises(ManycoreError, match="make one: `manycore whill course"):
        read_course(tmp_path)


def test_streets_that_are_broken(course, tmp_path: Path):
    (tmp_path / "mapfile").touch()
    write_course(tmp_path, course, tmp_path / "mapfile")
    (tmp_path / "streets.npz").write_bytes(b"PK\x03\x04")
    with pytest.raises(ManycoreError, match="expected the streets of a course"):
        read_course(tmp_path)
