# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""The mapfile of the reference system, with native nodes instead of those of rclpy."""

from __future__ import annotations

import shlex
from copy import deepcopy
from typing import Any

from rmw_manycore_py.bench.session import program_path
from rmw_manycore_py.papers.reference_system.bench.graph import members
from rmw_manycore_py.papers.reference_system.bench.system import NATIVE, Load, native_arguments


def with_native_nodes(mapfile: dict[str, Any]) -> dict[str, Any]:
    """Return the installed mapfile with a native program for each node."""
    variant = deepcopy(mapfile)
    for member in members():
        node = variant["nodes"][member.name]
        del node["module"]
        load = Load(node.pop("parameters")["message"])
        arguments = native_arguments(member, load).items()
        words = [str(program_path(NATIVE)), *(f"{key}={value}" for key, value in arguments)]
        # It ends with its parent, whose id a shell knows.
        node["command"] = ["sh", "-c", f"exec {shlex.join(words)} parent=$PPID"]
        node["ros_arguments"] = False
    return variant
