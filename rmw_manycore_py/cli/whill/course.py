# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""`manycore whill course`."""

from __future__ import annotations

from pathlib import Path

import click

from rmw_manycore_py.cli.common.options import examples, number_option
from rmw_manycore_py.cli.common.output_file import writing
from rmw_manycore_py.cli.common.printing import echo
from rmw_manycore_py.errors import ManycoreError
from rmw_manycore_py.mapfile.installed import find_mapfile
from rmw_manycore_py.ndt.maps.map_file import read_points
from rmw_manycore_py.papers.roslite2.course.directory import (
    MAP,
    TRAJECTORY,
    WHEEL_BASE_M,
    Course,
    check_inside,
    write_course,
)
from rmw_manycore_py.papers.roslite2.course.shape import CourseShape
from rmw_manycore_py.papers.roslite2.course.synthetic import synthetic_course
from rmw_manycore_py.papers.roslite2.course.trajectory_file import read_trajectory
from rmw_manycore_py.papers.roslite2.course.views import PointView
from rmw_manycore_py.papers.roslite2.laws.wheelchair import MAX_SPEED_M_S

MIN_STRAIGHT_M = 5.0


@click.command(
    "course",
    epilog=examples(
        "manycore whill course build/whill",
        "manycore whill course build/short --length 50 --turn-radius 8",
        "manycore whill course build/mine --map my_map.pcd --trajectory my_way.csv",
    ),
)
@click.argument("directory", type=click.Path(file_okay=False, path_type=Path))
@number_option(
    "--length",
    "length_m",
    within=(20.0, 2000.0),
    default=CourseShape.length_m,
    help="Length of the course in metres.",
)
@number_option(
    "--turn-radius",
    "turn_radius_m",
    within=(3.0, 50.0),
    default=CourseShape.turn_radius_m,
    help="Radius of the two turns in metres.",
)
@number_option(
    "--speed",
    "speed_m_s",
    within=(0.3, MAX_SPEED_M_S),
    default=CourseShape.speed_m_s,
    help="Speed on straights, metres per second.",
)
@number_option(
    "--turn-speed",
    "turn_speed_m_s",
    within=(0.3, MAX_SPEED_M_S),
    default=CourseShape.turn_speed_m_s,
    help="Speed in turns, metres per second.",
)
@number_option("--seed", within=(0, None), default=1, help="Seed of the streets.")
@click.option(
    "--map",
    "map_path",
    type=click.Path(exists=True, dir_okay=False, path_type=Path),
    help="Your own map (pcd, ply, npz) instead of streets; requires --trajectory.",
)
@click.option(
    "--trajectory",
    "trajectory_path",
    type=click.Path(exists=True, dir_okay=False, path_type=Path),
    help="Your own trajectory in --map: CSV with x_m,y_m,yaw_rad,speed_m_s.",
)
def command(
    directory: Path,
    seed: int,
    map_path: Path | None,
    trajectory_path: Path | None,
    **shape: float,
) -> None:
    """Write the files of a course to DIRECTORY.

    Map, trajectory, surroundings, and a mapfile that uses them. The streets are those of
    `manycore ndt simulate`, with a left and a right turn.
    """
    if (map_path is None) != (trajectory_path is None):
        raise click.UsageError("--map and --trajectory require each other")
    if map_path is not None and trajectory_path is not None:
        course = _own(map_path, trajectory_path)
    else:
        course = _synthetic(CourseShape(**shape), seed)
    mapfile = find_mapfile("whill")
    if mapfile is None:
        raise ManycoreError("the mapfile whill.yaml is not installed: run 'manycore doctor'")
    with writing(directory):
        directory.mkdir(parents=True, exist_ok=True)
        write_course(directory, course, mapfile)
    along_m = course.trajectory.along_m()
    echo(f"{directory / MAP}: {len(course.map_points)} points")
    echo(f"{directory / TRAJECTORY}: {len(course.trajectory)} points, {along_m[-1]:.0f} m")
    echo(f"next: manycore whill drive --course {directory} --run")


def _synthetic(shape: CourseShape, seed: int) -> Course:
    if shape.straight_m < MIN_STRAIGHT_M:
        needed = 2.0 * shape.turn_m + 3.0 * MIN_STRAIGHT_M
        raise click.UsageError(
            f"--length {shape.length_m:g}: with turns of {shape.turn_radius_m:g} m expected at "
            f"least {needed:.0f} m; or give a smaller --turn-radius"
        )
    return synthetic_course(shape, seed)


def _own(map_path: Path, trajectory_path: Path) -> Course:
    trajectory = read_trajectory(trajectory_path, WHEEL_BASE_M, MAX_SPEED_M_S)
    points = read_points(map_path)
    check_inside(trajectory, points, trajectory_path)
    return Course(trajectory, points, PointView(points))
