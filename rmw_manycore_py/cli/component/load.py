# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""`manycore component load`, with the output format of `ros2 component load`."""

from __future__ import annotations

import click

from rmw_manycore_py.cli.common.options import discovery_options, examples, platform_option
from rmw_manycore_py.cli.common.printing import echo
from rmw_manycore_py.cli.common.tool_node import tool_node
from rmw_manycore_py.cli.component.containers import (
    Container,
    Wanted,
    complete_containers,
    existing_container,
    loaded_line,
)
from rmw_manycore_py.cli.component.wanted_options import wanted_options


@click.command(
    "load",
    epilog=examples(
        "manycore component load /container composition composition::Talker",
        "manycore component load /container composition composition::Talker -r chatter:=/talk",
    ),
)
@click.argument("container", shell_complete=complete_containers)
@wanted_options
@click.option("-q", "--quiet", is_flag=True, help="Print only the component's id and name.")
@discovery_options
@platform_option
def command(container: str, wanted: Wanted, quiet: bool, platform: str) -> None:
    """Load PLUGIN of PACKAGE into CONTAINER."""
    name = existing_container(platform, container)
    with tool_node(platform) as tool:
        unique_id, node = Container(tool, name).load(wanted)
    if quiet:
        echo(f"{unique_id}  {node}")
    else:
        echo(loaded_line(unique_id, name, node))
