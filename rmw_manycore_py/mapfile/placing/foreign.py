# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""Nodes started by `ros2 launch`, for which the mapfile only defines the placement."""

from __future__ import annotations

from collections.abc import Iterator
from typing import TYPE_CHECKING

from rmw_manycore_py.errors import MapfileError, Problem
from rmw_manycore_py.mapfile.format.checks import WAYS_TO_START
from rmw_manycore_py.mapfile.placing.start import NodeStart
from rmw_manycore_py.mapfile.programs.executables import Program
from rmw_manycore_py.ros.names import expand

if TYPE_CHECKING:
    from rmw_manycore_py.mapfile.format.mapfile import Mapfile

# Keys that describe the command; under `ros2 launch` only the launch file may set them.
_KEYS_OF_A_START = (
    *WAYS_TO_START,
    *("package", "namespace", "parameters", "param_file", "remappings", "arguments"),
)


def foreign_starts(mapfile: Mapfile) -> dict[str, NodeStart]:
    """Return the nodes by their names in the mapfile, without programs."""
    problems = [*_refused_keys(mapfile)]
    if problems:
        raise MapfileError(*problems)
    return {name: _foreign_start(mapfile, name) for name in mapfile.sections.nodes}


def _refused_keys(mapfile: Mapfile) -> Iterator[Problem]:
    for name, node in mapfile.sections.nodes.items():
        for key in _KEYS_OF_A_START:
            if key in node.model_fields_set:
                path = ("nodes", name, key)
                expected = "no key that says how a node is started, as ros2 launch starts it"
                yield mapfile.document.problem(path, expected, f"'{key}'")


def _foreign_start(mapfile: Mapfile, name: str) -> NodeStart:
    return NodeStart(
        full_name=expand(name, "/"),
        program=Program((), None),
        ros_arguments=False,
        namespace=None,
        parameters={},
        parameter_sources=(),
        remappings=(),
        arguments=(),
        raw_ros_arguments=(),
        env=dict(mapfile.sections.nodes[name].env),
    )
