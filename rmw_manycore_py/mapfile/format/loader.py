# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""Loads a mapfile; reports all problems in one error."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path
from typing import Any

from pydantic import ValidationError

from rmw_manycore_py.errors import MapfileError, Problem
from rmw_manycore_py.mapfile.format.checks import (
    check_environment,
    check_files,
    check_hosts,
    check_placement,
    check_starts,
    check_topic_names,
)
from rmw_manycore_py.mapfile.format.document import (
    Document,
    KeyPath,
    parse_yaml,
    read_text,
)
from rmw_manycore_py.mapfile.format.mapfile import Mapfile
from rmw_manycore_py.mapfile.format.model import MapfileSections, PlatformSection
from rmw_manycore_py.mapfile.format.normalise import normalise
from rmw_manycore_py.mapfile.format.ros_lite import from_list
from rmw_manycore_py.mapfile.format.validation import describe, problems_of
from rmw_manycore_py.platform.topology import Topology, profile
from rmw_manycore_py.ros.parameter_files import read_scalar

_TEXTS = ("arguments", "command", "env")  # of a node: what YAML reads as `on` or 017 is no other


def load_mapfile(
    path: Path | str, *, starts_nodes: bool = True, text: str | None = None
) -> Mapfile:
    """Read and validate a mapfile or a .map list.

    With `starts_nodes=False` nodes need no way to start, since another launcher starts them.

    :param text: what the file will contain, if it is not written yet.
    :raises MapfileError: with all problems found.
    """
    path = Path(path)
    content = read_text(path) if text is None else text
    document = parse_yaml(content, path, reading=_reading)
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
        *check_hosts(mapfile),
        *check_topic_names(mapfile),
        *(check_starts(mapfile) if starts_nodes else ()),
        *check_environment(mapfile),
        *check_files(mapfile),
    ]
    if problems:
        raise MapfileError(*problems)
    return mapfile


def _reading(path: KeyPath) -> Callable[[str], Any] | None:
    """Return how to read values of a node: parameters as rcl does, texts as they are written."""
    if path[:1] == ("launch_arguments",):
        return str
    node = 1 if path and isinstance(path[0], int) else 2  # a .map file is a list of nodes
    key = path[node] if len(path) > node and (node == 1 or path[0] == "nodes") else None
    return read_scalar if key == "parameters" else str if key in _TEXTS else None


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
