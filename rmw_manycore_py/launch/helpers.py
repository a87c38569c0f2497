# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""Processes that load components and drive lifecycles, as requested by a launch file."""

from __future__ import annotations

import json
from collections.abc import Iterator
from dataclasses import asdict
from typing import Any

from rmw_manycore_program import own_program
from rmw_manycore_py.launch.processes.environment import program_environment
from rmw_manycore_py.launch.processes.program import NodeProgram
from rmw_manycore_py.mapfile.placing.placement import LaunchRules, PlacedNode, Placement


def helper_programs(placement: Placement) -> list[NodeProgram]:
    """Return a program per container and lifecycle node; it exits when its work is done."""
    return [program for node in placement.nodes for program in _helpers_of(node)]


def _helpers_of(node: PlacedNode) -> Iterator[NodeProgram]:
    rules = node.rules
    if rules.components:
        components = [asdict(one) for one in rules.components]
        request: dict[str, Any] = {"container": node.full_name, "components": components}
        yield _helper(node, f"(components of {node.name})", request)
    if rules.transitions:
        request = {"node": node.full_name, "transitions": list(rules.transitions)}
        yield _helper(node, f"(states of {node.name})", request)


def _helper(node: PlacedNode, name: str, request: dict[str, Any]) -> NodeProgram:
    return NodeProgram(
        name=name,
        command=own_program("rmw_manycore_py.launch.bring_up", json.dumps(request)),
        environment=program_environment({**node.env, "MANYCORE_SHARED_CORE": "1"}),
        core=node.place,
        host_cpus=(),
        directory=node.cwd,
        rules=LaunchRules(after=node.name),
        repeats=True,
    )
