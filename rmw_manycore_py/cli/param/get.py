# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""`manycore param get`, with the output format of `ros2 param get`."""

from __future__ import annotations

import click

from rmw_manycore_py.cli.common.completion import complete_nodes
from rmw_manycore_py.cli.common.options import examples, json_option
from rmw_manycore_py.cli.common.printing import echo, print_json
from rmw_manycore_py.cli.common.tool_node import tool_node
from rmw_manycore_py.cli.param.awaited_node import awaited_node_options, waited_for
from rmw_manycore_py.cli.param.parameters import TYPES, Parameters


@click.command("get", epilog=examples("manycore param get /controller gain"))
@click.argument("node", shell_complete=complete_nodes)
@click.argument("parameter")
@click.option("--hide-type", is_flag=True, help="Print only the value.")
@json_option
@awaited_node_options
def command(
    node: str, parameter: str, hide_type: bool, timeout_s: float, platform: str, as_json: bool
) -> None:
    """Print the value of PARAMETER of NODE."""
    name = waited_for(platform, node, timeout_s)
    with tool_node(platform) as tool:
        ((kind, value),) = Parameters(tool, name).values([parameter])
    if as_json:
        print_json({"name": parameter, "type": TYPES[kind][0], "value": value})
    elif hide_type:
        echo(value)
    else:
        echo(TYPES[kind][1] if value is None else f"{TYPES[kind][1]} {value}")
