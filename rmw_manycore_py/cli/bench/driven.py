# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""Mapfiles that run by themselves: of papers with their vehicle, and of recordings."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import click

from rmw_manycore_program import own_program
from rmw_manycore_py.bench.session import NODES
from rmw_manycore_py.errors.missing_library import MCAP, require
from rmw_manycore_py.mapfile.installed import installed_mapfiles
from rmw_manycore_py.papers.reference_system.bench.native_mapfile import with_native_nodes
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

REFERENCE = "autoware_reference.yaml"
RECORDING = ".mcap"
_DELAY_S = 1.0  # for the reader of a recording to start


def driven(mapfile: Path, directory: Path, *, native: bool = False) -> Path:
    """Return a mapfile that runs by itself.

    That is this one, unless it is an installed one of a paper, or a recording.

    :param directory: of what is written.
    """
    with_laptop = mapfile.parent / VIRTUAL_MAPFILE
    if native:
        if not _is_installed(mapfile, REFERENCE):
            raise click.UsageError("--native is for autoware_reference.")
        return write(with_native_nodes(installed(REFERENCE)), directory / REFERENCE)
    if mapfile.suffix == RECORDING:
        return write(_played(mapfile), directory / "played.yaml")
    if mapfile.name == MAPFILE and with_laptop.exists():
        return with_laptop
    if _is_installed(mapfile, MAPFILE):
        write_course(directory, synthetic_course(CourseShape(), seed=1), mapfile)
        return directory / VIRTUAL_MAPFILE
    if _is_installed(mapfile, AFTER):
        map_path = Street(LENGTH_M, waypoints=2).write_map(directory)
        report = str(directory / "drive.json")
        complete = with_vehicle(installed(AFTER), map_path, length=LENGTH_M, report=report)
        return write(complete, directory / "ros_lite.yaml")
    return mapfile


def _is_installed(mapfile: Path, name: str) -> bool:
    """Whether a file is the installed one of this name, or a copy of it."""
    known = {file.name: file for file in installed_mapfiles().values()}
    return (
        mapfile.name == name and name in known and mapfile.read_bytes() == known[name].read_bytes()
    )


def _played(recording: Path) -> dict[str, Any]:
    """Return a mapfile that plays a recording to one subscription of each topic."""
    require(MCAP)
    from rmw_manycore_py.recording.recording import Recording

    with Recording(recording) as opened:
        topics = [f"{row.name}={row.type}" for row in opened.topics]
    play = ("topic", "play", str(recording.absolute()), "--delay", f"{_DELAY_S:g}")
    programs = {
        "hearer": own_program(f"{NODES}.hearer", *topics),
        "player": own_program("rmw_manycore_py.cli", *play),
    }
    return {
        "platform": "coolidge",
        "nodes": {
            name: {
                "command": list(words),
                "cluster": cluster,
                "core": 1,
                "ros_arguments": False,
            }
            for cluster, (name, words) in enumerate(programs.items(), start=1)
        },
    }
