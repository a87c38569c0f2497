# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""Interface types that the sources of nodes import, and that a node cannot start without."""

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
    """Yield types that a node imports and that are not installed."""
    for name, start in starts.items():
        for type_name, place in _needed(start).items():
            package = type_name.split("/")[0]
            if not _is_installed(package, type_name):
                expected = f"{type_name} to be installed, which {place} imports"
                has = "without it" if ament.interfaces(package) else "not installed"
                found = f"the package '{package}' {has}"
                yield mapfile.document.problem(("nodes", name), expected, found)


def _needed(start: NodeStart) -> dict[str, str]:
    """Return what the source of a node imports, and where, if it runs in this environment."""
    source = start.program.source
    elsewhere = Path(start.program.argv[0]).parent != Path(sys.executable).parent
    if source is None or elsewhere or "PYTHONPATH" in start.env:
        return {}
    try:
        imported = imported_interfaces(source)
    except MapfileError:
        return {}  # Python will say what is wrong with it when it runs.
    return {type_name: f"{source.name}:{line}" for type_name, line in imported.items()}


def _is_installed(package: str, type_name: str) -> bool:
    known = ament.interfaces(package)
    # A package that is not of ROS may have a module `msg` all the same.
    return type_name in known or (not known and importlib.util.find_spec(package) is not None)
