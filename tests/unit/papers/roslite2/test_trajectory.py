# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""Trajectories: generated courses, files, and infeasible input."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

from rmw_manycore_py.errors import ManycoreError
from rmw_manycore_py.papers.roslite2.course.shape import CourseShape
from rmw_manycore_py.papers.roslite2.course.trajectory_file import read_trajectory, write_trajectory
from rmw_manycore_py.papers.roslite2.laws.trajectory import Trajectory

pytestmark = pytest.mark.unit

WHEEL_BASE_M, MAX_SPEED_M_S = 0.45, 1.67
HEADER = "x_m,y_m,yaw_rad,speed_m_s\n"


@pytest.mark.parametrize("shape", [CourseShape(), CourseShape(50.0, 8.0, 1.67, 1.2)])
def test_a_course_has_two_turns_and_can_be_driven(shape):
    way = shape.trajectory()
    assert way.problem(WHEEL_BASE_M, MAX_SPEED_M_S) is None
    assert way.along_m()[-1] == pytest.approx(shape.length_m, abs=0.01)
    end = shape.corners()[-1]
    assert (way.x_m[-1], way.y_m[-1]) == pytest.approx(end, abs=0.01)
    headings = np.degrees(way.yaw_rad)
    assert (headings[0], headings.max(), headings[-1]) == pytest.approx((0, 90, 0), abs=1e-6)
    assert way.speed_m_s[0] == shape.speed_m_s
    turning = np.abs(np.gradient(way.yaw_rad)) > 1e-3
    assert way.speed_m_s[turning].max() < shape.turn_speed_m_s + 0.1
    assert way.speed_m_s[-1] == 0.0


def test_nearest_and_lateral_error():
    generator = np.random.default_rng(2)
    way = CourseShape().trajectory()
    for x, y in generator.uniform(-20, 150, (100, 2)):
        distances = [(x - a) ** 2 + (y - b) ** 2 for a, b in zip(way.x_m, way.y_m, strict=True)]
        assert way.nearest(x, y) == distances.index(min(distances))
        assert way.distance_m(x, y) == pytest.approx(min(distances) ** 0.5)
    assert way.lateral_error_m(1.0, 0.3) == pytest.approx(0.3)


def test_a_file_there_and_back(tmp_path):
    way = CourseShape().trajectory()
    write_trajectory(tmp_path / "way.csv", way)
    back = read_trajectory(tmp_path / "way.csv", WHEEL_BASE_M, MAX_SPEED_M_S)
    for name in ("x_m", "y_m", "yaw_rad", "speed_m_s"):
        np.testing.assert_allclose(getattr(back, name), getattr(way, name), atol=1e-4)


@pytest.mark.parametrize(
    ("text", "said"),
    [
        ("", ":1: expected x_m,y_m,yaw_rad,speed_m_s, found "),
        ("a,b\n", ":1: expected x_m,y_m,yaw_rad,speed_m_s, found a,b"),
        (HEADER, ":2: expected two points or more, found 0"),
        (HEADER + "0,0,0,1\n1,0,zero,1\n", ":3: expected 4 numbers, found 1,0,zero,1"),
        (HEADER + "0,0,0,1\n1,0,0\n", ":3: expected 4 numbers, found 1,0,0"),
        (HEADER + "0,0,0,1\n1,nan,0,1\n", ":3: expected finite numbers, found 1 nan 0 1"),
        (HEADER + "0,0,0,1\n1,0,0,1.8\n", ":3: expected a speed from 0 to 1.67 m/s, found 1.8"),
        (HEADER + "0,0,0,-1\n1,0,0,1\n", ":2: expected a speed from 0 to 1.67 m/s, found -1"),
        (HEADER + "0,0,0,0\n1,0,0,1\n", ":2: expected a speed above 0 at the first point"),
        (HEADER + "0,0,0,1\n9,0,0,1\n", ":2: expected the next point between 0.001 and 2 m away"),
        (HEADER + "0,0,0,1\n0,0,0,1\n", ":2: expected the next point between 0.001 and 2 m away"),
        (HEADER + "0,0,2,1\n1,0,0,1\n", ":2: expected a yaw that points to the next point"),
        (
            HEADER + "0,0,0,1\n0.3,0,0.48,1\n0.6,0.1,0.48,1\n",
            ":2: expected a turn of a radius of at least 0.66 m, found 0.625",
        ),
    ],
)
def test_what_is_no_trajectory_is_named(tmp_path: Path, text: str, said: str):
    path = tmp_path / "way.csv"
    path.write_text(text)
    with pytest.raises(ManycoreError) as error:
        read_trajectory(path, WHEEL_BASE_M, MAX_SPEED_M_S)
    assert f"{path}{said}" in str(error.value)
    assert error.value.exit_status == 2


def test_a_file_that_is_missing(tmp_path):
    with pytest.raises(ManycoreError, match="cannot be read: No such file"):
        read_trajectory(tmp_path / "none.csv", WHEEL_BASE_M, MAX_SPEED_M_S)


def test_bytes_that_are_no_text(tmp_path):
    (tmp_path / "way.csv").write_bytes(b"\xff\xfe\x00")
    with pytest.raises(ManycoreError, match="cannot be read"):
        read_trajectory(tmp_path / "way.csv", WHEEL_BASE_M, MAX_SPEED_M_S)


def test_a_reversed_gap_is_found_at_its_point():
    way = Trajectory(
        *(np.array(column, float) for column in ([0, 1, 5], [0] * 3, [0] * 3, [1] * 3))
    )
    problem = way.problem(WHEEL_BASE_M, MAX_SPEED_M_S)
    assert problem is not None
    assert problem[0] == 1
