# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""`manycore param delete`, with the output format of `ros2 param delete`."""

from __future__ import annotations

import click

from rmw_manycore_py.cli.common.completion import complete_nodes
from rmw_manycore_py.cli.common.options import examples
from rmw_manycore_py.cli.common.printing import echo
from rmw_manycore_py.cli.common.tool_node import tool_node
from rmw_manycore_py.cli.param.awaited_node import awaited_node_options, waited_for
from rmw_manycore_py.cli.param.parameters import Parameters, parameter_of
from rmw_manycore_py.errors import ManycoreError


@click.command("delete", epilog=examples("manycore param delete /controller gain"))
@click.argument("node", shell_complete=complete_nodes)
@click.argument("parameter")
@awaited_node_options
def command(node: str, parameter: str, timeout_s: float, platform: str) -> None:
    """Delete PARAMETER of NODE.

    The node has to allow undeclared parameters.
    """
    name = waited_for(platform, node, timeout_s)
    with tool_node(platform) as tool:
        ((_, result),) = Parameters(tool, name).set([parameter_of(parameter, None)])
    reason = f": {result.reason}" if result.reason else ""
    if not result.successful:
        raise ManycoreError(f"Deleting parameter failed{reason}")
    echo(f"Deleted parameter successfully{reason}")
