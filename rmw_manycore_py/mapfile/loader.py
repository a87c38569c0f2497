# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""Reads a mapfile; everything that is wrong with it comes in one error."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path

from pydantic import ValidationError

from rmw_manycore_py.errors import MapfileError, Problem
from rmw_manycore_py.mapfile.checks import (
    check_environment,
    check_files,
    check_placement,
    check_starts,
)
from rmw_manycore_py.mapfile.document import Document, read_yaml
from rmw_manycore_py.mapfile.model import MapfileSections, PlatformSection
from rmw_manycore_py.mapfile.normalise import normalise
from rmw_manycore_py.mapfile.ros_lite import from_list
from rmw_manycore_py.mapfile.validation import describe, problems_of
from rmw_manycore_py.topology import Topology, profile


@dataclass(frozen=True)
class Mapfile:
    """A mapfile that is valid in itself; whether its executables exist is `resolve`'s business."""

    path: Path
    sections: MapfileSections
    topology: Topology
    document: Document
    notices: tuple[str, ...]

    def file(self, name: str) -> Path:
        """Return a file the mapfile names: relative to the mapfile, `~` expanded."""
        return (self.path.parent / Path(name).expanduser()).resolve()


def load_mapfile(path: Path | str) -> Mapfile:
    """Read and check a mapfile or a .map list."""
    path = Path(path)
    document = read_yaml(path)
    if isinstance(document.data, list):
        document = from_list(document)
    if not isinstance(document.data, dict):
        expected = "a mapping with the key 'nodes', or a list of nodes"
        raise MapfileError(document.problem((), expected, describe(document.data)))
    notices = normalise(document)
    sections = _validate(document)
    mapfile = Mapfile(path, sections, _topology(sections.platform), document, tuple(notices))
    problems = [
        *check_placement(mapfile),
        *check_starts(mapfile),
        *check_environment(mapfile),
        *check_files(mapfile),
    ]
    if problems:
        raise MapfileError(*problems)
    return mapfile


def _validate(document: Document) -> MapfileSections:
    try:
        return MapfileSections.model_validate(document.data)
    except ValidationError as error:
        problems: list[Problem] = problems_of(error, document)
    raise MapfileError(*problems)


def _topology(platform: PlatformSection) -> Topology:
    return profile(
        platform.profile,
        clusters=platform.clusters,
        cores_per_cluster=platform.cores_per_cluster,
        smem_size=platform.smem_size,
    )
