# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""Directory of a course: map, trajectory, streets, and a mapfile that refers to them."""

from __future__ import annotations

import re
import shlex
import shutil
from dataclasses import dataclass
from pathlib import Path

import numpy as np

from rmw_manycore_py.errors import EXIT_BAD_INPUT, ManycoreError
from rmw_manycore_py.ndt.geometry.arrays import Points
from rmw_manycore_py.ndt.geometry.poses import from_xyz_rpy, transform
from rmw_manycore_py.ndt.geometry.thinning import voxel_centroids
from rmw_manycore_py.ndt.maps.map_file import read_points, write_points
from rmw_manycore_py.papers.roslite2.course.streets import load_streets, save_streets
from rmw_manycore_py.papers.roslite2.course.trajectory_file import read_trajectory, write_trajectory
from rmw_manycore_py.papers.roslite2.course.views import PointView, StreetView, View
from rmw_manycore_py.papers.roslite2.laws.trajectory import Trajectory
from rmw_manycore_py.papers.roslite2.laws.wheelchair import MAX_SPEED_M_S

MAP, TRAJECTORY, STREETS, MAPFILE = "map.npz", "trajectory.csv", "streets.npz", "whill.yaml"
VIRTUAL_MAPFILE = "whill_virtual.yaml"
# The laptop as a node, for virtual time, in which there is no bridge to it. It is another computer:
# it has a cluster that no node uses.
LAPTOP = """\
  whill_laptop:
    module: rmw_manycore_py.papers.roslite2.laptop
    cluster: 5
    core: 1
    ends_run: true
"""
WHEEL_BASE_M = 0.45
MAP_VOXEL_M = 0.2
MAPPING_STEP_M = 3.0
MAPPING_SIDE_M = 0.5  # lateral offset of the mapping vehicle, to the left
CELL_M = 10.0  # 3 x 3 cells around each point of the course must contain map points
MIN_MAP_POINTS = 200  # excluding the ground, which does not constrain x, y and yaw
ABOVE_GROUND_M = 0.5


@dataclass(frozen=True)
class Course:
    """A trajectory, its map, and its surroundings."""

    trajectory: Trajectory
    map_points: Points
    view: View


def write_course(directory: Path, course: Course, mapfile: Path) -> None:
    """Write the files of a course, including the mapfile."""
    write_points(directory / MAP, course.map_points)
    write_trajectory(directory / TRAJECTORY, course.trajectory)
    if isinstance(course.view, StreetView):
        save_streets(directory / STREETS, course.view.street)
    else:
        (directory / STREETS).unlink(missing_ok=True)
    shutil.copyfile(mapfile, directory / MAPFILE)
    # Without workers, whose time virtual time would not count.
    alone = re.sub(r"^    workers: .*\n", "", mapfile.read_text(), flags=re.MULTILINE)
    (directory / VIRTUAL_MAPFILE).write_text(alone + LAPTOP)


def read_course(directory: Path) -> Course:
    """Read a drivable course; without streets the LiDAR sees the map's points."""
    if not (directory / TRAJECTORY).is_file():
        raise ManycoreError(
            f"{directory}: expected a course, found no {TRAJECTORY}; make one: "
            f"`manycore whill course {shlex.quote(str(directory))}`",
            EXIT_BAD_INPUT,
        )
    trajectory = read_trajectory(directory / TRAJECTORY, WHEEL_BASE_M, MAX_SPEED_M_S)
    points = read_points(directory / MAP)
    check_inside(trajectory, points, directory / TRAJECTORY)
    has_streets = (directory / STREETS).is_file()
    view = StreetView(load_streets(directory / STREETS)) if has_streets else PointView(points)
    return Course(trajectory, points, view)


def check_inside(trajectory: Trajectory, map_points: Points, path: Path) -> None:
    """Raise an error if a trajectory leaves the map, where no pose can be matched."""
    upright = map_points[map_points[:, 2] > map_points[:, 2].min() + ABOVE_GROUND_M, :2]
    cells, counts = np.unique(_cells(upright), axis=0, return_counts=True)
    count_of = dict(zip(map(tuple, cells.tolist()), counts.tolist(), strict=True))
    places = np.column_stack([trajectory.x_m, trajectory.y_m])
    for index, (x, y) in enumerate(_cells(places).tolist()):
        around = ((x + i, y + j) for i in (-1, 0, 1) for j in (-1, 0, 1))
        if sum(count_of.get(cell, 0) for cell in around) < MIN_MAP_POINTS:
            raise ManycoreError(
                f"{path}:{index + 2}: expected a course inside the map, found fewer than "
                f"{MIN_MAP_POINTS} points of the map around "
                f"({places[index, 0]:.1f}, {places[index, 1]:.1f})",
                EXIT_BAD_INPUT,
            )


def _cells(places: Points) -> Points:
    cells: Points = np.floor(places / CELL_M).astype(np.int64)
    return cells


def mapped(view: View, trajectory: Trajectory, generator: np.random.Generator) -> list[Points]:
    """Return scans (N, 3) in the map frame from beside a trajectory; downsample them for a map."""
    stride = max(1, round(MAPPING_STEP_M / float(np.median(np.diff(trajectory.along_m())))))
    clouds = []
    for index in range(0, len(trajectory), stride):
        pose = trajectory.pose(index)
        x_m = pose.x_m - MAPPING_SIDE_M * np.sin(pose.yaw_rad)
        y_m = pose.y_m + MAPPING_SIDE_M * np.cos(pose.yaw_rad)
        scan = view.scan(x_m, y_m, pose.yaw_rad, generator)
        clouds.append(transform(from_xyz_rpy((x_m, y_m, 0.0), (0.0, 0.0, pose.yaw_rad)), scan))
    return clouds


def thinned(clouds: list[Points]) -> Points:
    """Return a downsampled map of the clouds, in the map frame."""
    return voxel_centroids(np.concatenate(clouds), (MAP_VOXEL_M,) * 3)
