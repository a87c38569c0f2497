# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""Runs Python launch files with recording stand-ins of `launch` and `launch_ros`."""

from __future__ import annotations

from pathlib import Path
from typing import Any

from rmw_manycore_py.errors import MapfileError, Problem
from rmw_manycore_py.mapfile.launch_file import actions as a
from rmw_manycore_py.mapfile.launch_file.frame import MODULE_NAME
from rmw_manycore_py.mapfile.launch_file.guard import guarded
from rmw_manycore_py.mapfile.launch_file.missing_modules import open_or_missing
from rmw_manycore_py.mapfile.launch_file.placeholders import Missing, reason_of


def read_python(path: Path) -> a.LaunchDescription:
    """Run a launch file and return its LaunchDescription."""
    namespace: dict[str, Any] = {
        "__file__": str(path),
        "__name__": MODULE_NAME,
        "open": open_or_missing,
    }
    code = guarded(path, lambda: compile(path.read_bytes(), str(path), "exec"))
    guarded(path, exec, code, namespace)
    generate = namespace.get("generate_launch_description")
    if generate is None:
        expected = "a function generate_launch_description"
        raise MapfileError(Problem(path, 0, "", expected, "none"))
    description = guarded(path, generate)
    if isinstance(description, Missing):
        raise reason_of(description)
    if not isinstance(description, a.LaunchDescription):
        expected = "a LaunchDescription from generate_launch_description"
        raise MapfileError(Problem(path, 0, "", expected, type(description).__name__))
    return description
