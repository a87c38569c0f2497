# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""Reads launch files of any kind without the package `launch`."""

from __future__ import annotations

import os
from collections.abc import Iterator, Mapping
from contextlib import contextmanager
from dataclasses import dataclass
from pathlib import Path

from rmw_manycore_distribution import NAME
from rmw_manycore_py.errors import MapfileError
from rmw_manycore_py.mapfile.launch_file.context import LaunchContext
from rmw_manycore_py.mapfile.launch_file.elements import read_xml, read_yaml_elements
from rmw_manycore_py.mapfile.launch_file.frontend import description
from rmw_manycore_py.mapfile.launch_file.include import FRONTENDS, read_into
from rmw_manycore_py.mapfile.launch_file.launched import LaunchedNode
from rmw_manycore_py.mapfile.launch_file.python_file import read_python
from rmw_manycore_py.mapfile.launch_file.reading_process import read_in_child
from rmw_manycore_py.mapfile.launch_file.refusals import LaunchFileError
from rmw_manycore_py.mapfile.launch_file.stand_ins import install_stand_ins

# Variables of a sourced ROS 2 that launch files read; the wheels need no sourcing.
_ROS_ENVIRONMENT = {"ROS_DISTRO": NAME, "ROS_VERSION": "2", "ROS_PYTHON_VERSION": "3"}

FRONTENDS.update(
    {
        ".launch": lambda file: description(read_xml(file)),
        ".xml": lambda file: description(read_xml(file)),
        ".yaml": lambda file: description(read_yaml_elements(file)),
        ".yml": lambda file: description(read_yaml_elements(file)),
        ".py": read_python,
    }
)


@dataclass(frozen=True)
class LaunchFile:
    """Contents of a launch file."""

    file: Path
    nodes: tuple[LaunchedNode, ...]
    arguments: frozenset[str]
    notices: tuple[str, ...]


def read_launch_file(file: Path, arguments: Mapping[str, str] | None = None) -> LaunchFile:
    """Read a launch file with the given launch arguments."""
    return read_in_child(file, lambda: _read(file, arguments or {}))


def _read(file: Path, arguments: Mapping[str, str]) -> LaunchFile:
    context = LaunchContext(file, arguments)
    try:
        with _ros_environment():
            install_stand_ins(context)
            read_into(context, file)
            with context.reading(file):
                context.finish()
    except LaunchFileError as refused:
        raise MapfileError(refused.at(file, 0)) from refused
    declared = frozenset(context.declared)
    nodes = tuple(context.result())
    return LaunchFile(file, nodes, declared, tuple(context.notices))


@contextmanager
def _ros_environment() -> Iterator[None]:
    """Set the variables of a sourced ROS 2 while the launch file is read."""
    added = {name: value for name, value in _ROS_ENVIRONMENT.items() if name not in os.environ}
    os.environ.update(added)
    try:
        yield
    finally:
        for name in added:
            os.environ.pop(name, None)
