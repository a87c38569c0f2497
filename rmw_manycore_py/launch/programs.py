# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""Programs of a placement's nodes, and the files that they are started with."""

from __future__ import annotations

from collections.abc import Iterable
from pathlib import Path

from rmw_manycore_py.errors import EXIT_BAD_INPUT, ManycoreError
from rmw_manycore_py.launch.helpers import helper_programs
from rmw_manycore_py.launch.processes.program import NodeProgram
from rmw_manycore_py.launch.runs.private import replace_private
from rmw_manycore_py.mapfile.placing.placement import PlacedNode, Placement
from rmw_manycore_py.process.scheduling import refusal


def programs_of(placement: Placement, parameters: Path) -> list[NodeProgram]:
    """Return the programs of nodes, then those of their helpers."""
    nodes = [NodeProgram.of(node, parameters) for node in placement.nodes]
    return [*nodes, *helper_programs(placement)]


def write_parameters(nodes: Iterable[PlacedNode], directory: Path) -> None:
    """Write the parameter files of nodes; those of running ones are replaced."""
    for node in nodes:
        for file in node.generated_files:
            directory.mkdir(0o700, exist_ok=True)
            replace_private(directory / file.name, file.text)


def check_scheduling(placement: Placement) -> None:
    """Check before the start that this user may set the requested policies."""
    refused = [
        f"'{node.name}': {reason}"
        for node in placement.nodes
        if node.scheduling is not None and (reason := refusal(node.scheduling))
    ]
    if refused:
        raise ManycoreError("\n".join(refused), EXIT_BAD_INPUT)
