# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""Interface types imported by the sources of nodes, without which a node cannot start."""

from __future__ import annotations

import importlib.util
import sys
from collections.abc import Iterator, Mapping
from pathlib import Path
from typing import TYPE_CHECKING

from rmw_manycore_py.errors import MapfileError, Problem
from rmw_manycore_py.mapfile.programs.source import imported_interfaces
from rmw_manycore_py.ros import ament

if TYPE_CHECKING:
    from rmw_manycore_py.mapfile.format.mapfile import Mapfile
    from rmw_manycore_py.mapfile.placing.start import NodeStart


def check_imports(mapfile: Mapfile, starts: Mapping[str, NodeStart]) -> Iterator[Problem]:
    """Yield types imported by a node whose packages are not installed."""
    for name, start in starts.items():
        for type_name, place in _missing(start):
            package = type_name.split("/")[0]
            if not ament.interfaces(package):
                expected = f"{type_name} to be installed, which {place} imports"
                found = f"the package '{package}' not installed"
                yield mapfile.document.problem(("nodes", name), expected, found)


def notices_of_imports(starts: Mapping[str, NodeStart]) -> Iterator[str]:
    """Yield types imported by a node that their installed packages do not define.

    This is a notice only: a program may add a type to a package before importing it, as rosboard
    does.
    """
    for name, start in starts.items():
        for type_name, place in _missing(start):
            if ament.interfaces(type_name.split("/")[0]):
                yield f"'{name}' imports {type_name} ({place}), which its package does not have"


def _missing(start: NodeStart) -> Iterator[tuple[str, str]]:
    for type_name, place in _needed(start).items():
        if not _is_installed(type_name.split("/")[0], type_name):
            yield type_name, place


def _needed(start: NodeStart) -> dict[str, str]:
    """Return the types that a node's source imports, with locations, if it runs here."""
    source = start.program.source
    if source is None or "PYTHONPATH" in start.env:
        return {}
    if Path(start.program.argv[0]).parent != Path(sys.executable).parent:
        return {}
    try:
        imported = imported_interfaces(source)
    except MapfileError:
        return {}  # Python reports the error at run time.
    return {type_name: f"{source.name}:{line}" for type_name, line in imported.items()}


def _is_installed(package: str, type_name: str) -> bool:
    known = ament.interfaces(package)
    # A package that is not a ROS package may also have a module `msg`.
    return type_name in known or (not known and importlib.util.find_spec(package) is not None)
