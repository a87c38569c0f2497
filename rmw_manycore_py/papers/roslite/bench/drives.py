# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""Runs the pipeline from a mapfile, with the vehicle, until the vehicle has its figures."""

from __future__ import annotations

import itertools
import os
import sys
import tempfile
import time
from collections.abc import Callable
from functools import cache
from pathlib import Path
from typing import IO, TypeVar

from rmw_manycore_hook import plain_environment
from rmw_manycore_program import own_program
from rmw_manycore_py.bench.session import Process
from rmw_manycore_py.errors import ManycoreError
from rmw_manycore_py.papers.roslite.variants import Variant, with_vehicle, write
from rmw_manycore_py.papers.roslite.vehicle.course import Course
from rmw_manycore_py.papers.roslite.vehicle.drive_log import DriveFigures

LENGTH_M = 330.0
START_S = 60.0
SCAN_PERIOD_S = 0.1
LOOK_AGAIN_AFTER_S = 0.05

T = TypeVar("T")
_numbers = itertools.count()


@cache
def _map_directory() -> tempfile.TemporaryDirectory[str]:
    """Return the directory of the map, which all drives of this process share."""
    directory = tempfile.TemporaryDirectory(prefix="ros-lite-")
    Course(LENGTH_M, waypoints=2).write_map(Path(directory.name))
    return directory


def drive(
    variant: Variant,
    scans: int,
    *,
    waypoints: int = 1000,
    drives: bool = True,
    meanwhile: Callable[[str], T],
) -> tuple[DriveFigures, T]:
    """Return the figures of `scans` scans, and the result of `meanwhile`.

    :param meanwhile: called with the platform once there are figures; the vehicle drives on.
    :raises ManycoreError: if the run ends early, or takes far too long.
    """
    map_path = Path(_map_directory().name, "map.npz")
    platform = f"bench-{os.getpid()}-ros-lite-{next(_numbers)}"
    with tempfile.TemporaryDirectory() as name:
        report = Path(name, "drive.json")
        parameters = {"length": LENGTH_M, "waypoints": waypoints, "scans": scans}
        driven = with_vehicle(variant, map_path, **parameters, drives=drives, report=str(report))
        mapfile = write(driven, Path(name, "ros_lite.yaml"))
        with Path(name, "output").open("w+") as output:
            run = _started(mapfile, platform, output)
            try:
                _wait_for(report, run, START_S + 3 * SCAN_PERIOD_S * scans)
                found = meanwhile(platform)
                run.interrupt()
                run.finish()
            finally:
                run.close()
        return DriveFigures.read(report), found


def _started(mapfile: Path, platform: str, output: IO[str]) -> Process:
    environment = {
        **plain_environment(os.environ, sys.prefix),
        "MANYCORE_PLATFORM": platform,
        "ROS_DOMAIN_ID": str(os.getpid() % 100 + 1),
    }
    command = own_program("rmw_manycore_py.cli", "run", str(mapfile))
    cpus = sorted(os.sched_getaffinity(0))
    return Process("ros-lite", command, environment, cpus, output=output)


def _wait_for(report: Path, run: Process, timeout_s: float) -> None:
    deadline_s = time.monotonic() + timeout_s
    while not report.exists():
        run.raise_if_failed()
        if time.monotonic() > deadline_s:
            raise ManycoreError(f"the vehicle has no figures after {timeout_s:g} s")
        time.sleep(LOOK_AGAIN_AFTER_S)


def nothing(_platform: str) -> None:
    """Do nothing meanwhile."""
