# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""`manycore param dump`, with the output format of `ros2 param dump`."""

from __future__ import annotations

import click
import yaml

from rmw_manycore_py.cli.common.completion import complete_nodes
from rmw_manycore_py.cli.common.options import examples, json_option
from rmw_manycore_py.cli.common.printing import echo, print_json
from rmw_manycore_py.cli.common.tool_node import tool_node
from rmw_manycore_py.cli.param.awaited_node import awaited_node_options, waited_for
from rmw_manycore_py.cli.param.parameters import Parameters, nested


@click.command("dump", epilog=examples("manycore param dump /controller > controller.yaml"))
@click.argument("node", shell_complete=complete_nodes)
@json_option
@awaited_node_options
def command(node: str, timeout_s: float, platform: str, as_json: bool) -> None:
    """Print all parameters of NODE as a parameter file."""
    name = waited_for(platform, node, timeout_s)
    with tool_node(platform) as tool:
        parameters = Parameters(tool, name)
        names = parameters.names()
        values = [value for _, value in parameters.values(names)]
    file = {name: {"ros__parameters": nested(zip(names, values, strict=True))}}
    if as_json:
        print_json(file)
    else:
        echo(yaml.safe_dump(file, default_flow_style=False))
