# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""The installed mapfiles of papers, with the vehicle that they need as a node of the run."""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path
from tempfile import TemporaryDirectory

from rmw_manycore_py.papers.roslite.bench.drives import LENGTH_M
from rmw_manycore_py.papers.roslite.variants import AFTER, installed, with_vehicle, write
from rmw_manycore_py.papers.roslite.vehicle.course import Course as Street
from rmw_manycore_py.papers.roslite2.course.directory import (
    MAPFILE,
    VIRTUAL_MAPFILE,
    write_course,
)
from rmw_manycore_py.papers.roslite2.course.shape import CourseShape
from rmw_manycore_py.papers.roslite2.course.synthetic import synthetic_course


@contextmanager
def driven(mapfile: Path) -> Iterator[Path]:
    """Yield a mapfile that runs by itself: this one, unless it is named `ros_lite` or `whill`."""
    with_laptop = mapfile.parent / VIRTUAL_MAPFILE
    if mapfile.name == MAPFILE and with_laptop.exists():
        yield with_laptop
        return
    if mapfile.name not in (AFTER, MAPFILE):
        yield mapfile
        return
    with TemporaryDirectory(prefix="driven-") as name:
        directory = Path(name)
        if mapfile.name == AFTER:
            map_path = Street(LENGTH_M, waypoints=2).write_map(directory)
            report = str(directory / "drive.json")
            driven = with_vehicle(installed(AFTER), map_path, length=LENGTH_M, report=report)
            yield write(driven, directory / "ros_lite.yaml")
        else:
            write_course(directory, synthetic_course(CourseShape(), seed=1), mapfile)
            yield directory / VIRTUAL_MAPFILE
