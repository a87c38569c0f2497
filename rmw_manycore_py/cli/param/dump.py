# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""`manycore param dump`, printed as `ros2 param dump` prints."""

from __future__ import annotations

import click
import yaml

from rmw_manycore_py.cli.common.node_names import existing_node
from rmw_manycore_py.cli.common.options import examples, json_option, platform_option
from rmw_manycore_py.cli.common.printing import print_json
from rmw_manycore_py.cli.common.tool_node import tool_node
from rmw_manycore_py.cli.param.parameters import Parameters, nested


@click.command("dump", epilog=examples("manycore param dump /controller > controller.yaml"))
@click.argument("node")
@json_option
@platform_option
def command(node: str, platform: str, as_json: bool) -> None:
    """Print all parameters of NODE as a parameter file."""
    name = existing_node(platform, node)
    with tool_node(platform) as tool:
        parameters = Parameters(tool, name)
        names = parameters.names()
        values = [value for _, value in parameters.values(names)]
    file = {name: {"ros__parameters": nested(zip(names, values, strict=True))}}
    if as_json:
        print_json(file)
    else:
        click.echo(yaml.safe_dump(file, default_flow_style=False))
