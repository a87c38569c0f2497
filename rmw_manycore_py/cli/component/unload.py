# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""`manycore component unload`, with the output format of `ros2 component unload`."""

from __future__ import annotations

import click

from rmw_manycore_py.cli.common.finite_range import WholeRange
from rmw_manycore_py.cli.common.options import discovery_options, examples, platform_option
from rmw_manycore_py.cli.common.printing import echo
from rmw_manycore_py.cli.common.tool_node import tool_node
from rmw_manycore_py.cli.component.containers import (
    Container,
    complete_containers,
    existing_container,
)


@click.command("unload", epilog=examples("manycore component unload /container 1 2"))
@click.argument("container", shell_complete=complete_containers)
@click.argument("ids", metavar="ID...", nargs=-1, type=WholeRange(0), required=True)
@click.option("-q", "--quiet", is_flag=True, help="Print only the ids.")
@discovery_options
@platform_option
def command(container: str, ids: tuple[int, ...], quiet: bool, platform: str) -> None:
    """Unload components from CONTAINER by their IDs."""
    name = existing_container(platform, container)
    with tool_node(platform) as tool:
        for unique_id in ids:
            Container(tool, name).unload(unique_id)
            echo(
                unique_id
                if quiet
                else f"Unloaded component {unique_id} from '{name}' container node"
            )
