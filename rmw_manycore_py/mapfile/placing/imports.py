# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""Interface types imported by the sources of nodes, without which a node cannot start."""

from __future__ import annotations

import importlib.util
import sys
from collections.abc import Iterator, Mapping
from pathlib import Path
from typing import TYPE_CHECKING

from rmw_manycore_py.errors import Problem
from rmw_manycore_py.ros import ament

if TYPE_CHECKING:
    from rmw_manycore_py.mapfile.format.mapfile import Mapfile
    from rmw_manycore_py.mapfile.placing.start import NodeStart


def check_imports(
    mapfile: Mapfile, starts: Mapping[str, NodeStart]
) -> tuple[list[Problem], list[str]]:
    """Return a problem for each imported type whose package is not installed, and notices.

    A type that its installed package does not define is a notice only: a program may add it to the
    package before importing it, as rosboard does.
    """
    problems: list[Problem] = []
    notices: list[str] = []
    for name, start in starts.items():
        for type_name, place in _missing(start):
            package = type_name.split("/")[0]
            if ament.interfaces(package):
                notices.append(
                    f"'{name}' imports {type_name} ({place}), which its package does not have"
                )
                continue
            expected = f"{type_name} to be installed, which {place} imports"
            found = f"the package '{package}' not installed"
            problems.append(mapfile.document.problem(("nodes", name), expected, found))
    return problems, notices


def _missing(start: NodeStart) -> Iterator[tuple[str, str]]:
    for type_name, place in _needed(start).items():
        if not _is_installed(type_name.split("/")[0], type_name):
            yield type_name, place


def _needed(start: NodeStart) -> dict[str, str]:
    """Return the types that a node's source imports, with locations, if it runs here."""
    file, source = start.program.source, start.source
    if file is None or source is None or "PYTHONPATH" in start.env:
        return {}
    if Path(start.program.argv[0]).parent != Path(sys.executable).parent:
        return {}
    return {type_name: f"{file.name}:{line}" for type_name, line in source.interfaces.items()}


def _is_installed(package: str, type_name: str) -> bool:
    known = ament.interfaces(package)
    # A package that is not a ROS package may also have a module `msg`.
    return type_name in known or (not known and importlib.util.find_spec(package) is not None)
