# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""`manycore param load`, printed as `ros2 param load` prints."""

from __future__ import annotations

import click

from rmw_manycore_py.cli.common.node_names import existing_node
from rmw_manycore_py.cli.common.options import examples, platform_option
from rmw_manycore_py.cli.common.tool_node import tool_node
from rmw_manycore_py.cli.param.parameters import Parameters, parameters_of_file
from rmw_manycore_py.errors import ManycoreError


@click.command("load", epilog=examples("manycore param load /controller controller.yaml"))
@click.argument("node")
@click.argument("file", type=click.Path(dir_okay=False, exists=True))
@platform_option
def command(node: str, file: str, platform: str) -> None:
    """Set the parameters of NODE that stand in a parameter FILE."""
    name = existing_node(platform, node)
    refused = []
    with tool_node(platform) as tool:
        wanted = parameters_of_file(file, name)
        for parameter, result in Parameters(tool, name).set(wanted):
            reason = f": {result.reason}" if result.reason else ""
            if result.successful:
                click.echo(f"Set parameter {parameter} successful{reason}")
            else:
                refused.append(f"Set parameter {parameter} failed{reason}")
    if refused:
        raise ManycoreError("\n".join(refused))
