# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""`manycore param load`, with the output format of `ros2 param load`."""

from __future__ import annotations

import click

from rmw_manycore_py.cli.common.completion import complete_nodes
from rmw_manycore_py.cli.common.options import examples
from rmw_manycore_py.cli.common.printing import echo
from rmw_manycore_py.cli.common.tool_node import tool_node
from rmw_manycore_py.cli.param.awaited_node import awaited_node_options, waited_for
from rmw_manycore_py.cli.param.parameters import Parameters, parameters_of_file
from rmw_manycore_py.errors import ManycoreError


@click.command("load", epilog=examples("manycore param load /controller controller.yaml"))
@click.argument("node", shell_complete=complete_nodes)
@click.argument("file", type=click.Path(dir_okay=False, exists=True))
@click.option(
    "--no-use-wildcard", is_flag=True, help="Skip sections for several nodes, such as /**."
)
@awaited_node_options
def command(node: str, file: str, no_use_wildcard: bool, timeout_s: float, platform: str) -> None:
    """Set the parameters of NODE from a parameter FILE."""
    name = waited_for(platform, node, timeout_s)
    refused = []
    with tool_node(platform) as tool:
        wanted = parameters_of_file(file, name, wildcard=not no_use_wildcard)
        for parameter, result in Parameters(tool, name).set(wanted):
            reason = f": {result.reason}" if result.reason else ""
            if result.successful:
                echo(f"Set parameter {parameter} successful{reason}")
            else:
                refused.append(f"Set parameter {parameter} failed{reason}")
    if refused:
        raise ManycoreError("\n".join(refused))
