# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""`manycore param set`, with the output format of `ros2 param set`."""

from __future__ import annotations

import click

from rmw_manycore_py.cli.common.completion import complete_nodes
from rmw_manycore_py.cli.common.options import examples
from rmw_manycore_py.cli.common.printing import echo
from rmw_manycore_py.cli.common.tool_node import tool_node
from rmw_manycore_py.cli.param.awaited_node import awaited_node_options, waited_for
from rmw_manycore_py.cli.param.parameters import Parameters, parameter_of
from rmw_manycore_py.errors import ManycoreError


@click.command(
    "set",
    context_settings={"ignore_unknown_options": True},  # a value may be -1
    epilog=examples("manycore param set /controller gain 2.5"),
)
@click.argument("node", shell_complete=complete_nodes)
@click.argument("parameter")
@click.argument("value")
@awaited_node_options
def command(node: str, parameter: str, value: str, timeout_s: float, platform: str) -> None:
    """Set PARAMETER of NODE to VALUE, given in YAML."""
    name = waited_for(platform, node, timeout_s)
    with tool_node(platform) as tool:
        parameters = Parameters(tool, name)
        ((_, result),) = parameters.set([parameter_of(parameter, value)])
        meant = "" if result.successful else parameters.meant_by(parameter)
    reason = f": {result.reason}" if result.reason else ""
    if not result.successful:
        raise ManycoreError(f"Setting parameter failed{reason}{meant}")
    echo(f"Set parameter successful{reason}")
