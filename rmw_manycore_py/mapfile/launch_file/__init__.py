# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""Reads ROS 2 launch files (XML, YAML, Python) without starting anything."""

from rmw_manycore_py.mapfile.launch_file.launched import (
    ExpandedFile,
    ForAllNodes,
    GivenByName,
    LaunchedComponent,
    LaunchedNode,
    ParameterSource,
    Respawn,
    Start,
    numbered,
)
from rmw_manycore_py.mapfile.launch_file.reader import LaunchFile, read_launch_file

__all__ = [
    "ExpandedFile",
    "ForAllNodes",
    "GivenByName",
    "LaunchFile",
    "LaunchedComponent",
    "LaunchedNode",
    "ParameterSource",
    "Respawn",
    "Start",
    "numbered",
    "read_launch_file",
]
