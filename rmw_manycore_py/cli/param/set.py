# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""`manycore param set`, printed as `ros2 param set` prints."""

from __future__ import annotations

import click

from rmw_manycore_py.cli.common.node_names import existing_node
from rmw_manycore_py.cli.common.options import examples, platform_option
from rmw_manycore_py.cli.common.tool_node import tool_node
from rmw_manycore_py.cli.param.parameters import Parameters, parameter_of
from rmw_manycore_py.errors import ManycoreError


@click.command("set", epilog=examples("manycore param set /controller gain 2.5"))
@click.argument("node")
@click.argument("parameter")
@click.argument("value")
@platform_option
def command(node: str, parameter: str, value: str, platform: str) -> None:
    """Set a PARAMETER of NODE to a VALUE in YAML."""
    name = existing_node(platform, node)
    with tool_node(platform) as tool:
        ((_, result),) = Parameters(tool, name).set([parameter_of(parameter, value)])
    reason = f": {result.reason}" if result.reason else ""
    if not result.successful:
        raise ManycoreError(f"Setting parameter failed{reason}")
    click.echo(f"Set parameter successful{reason}")
