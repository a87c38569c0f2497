# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""`manycore lifecycle get`, printed as `ros2 lifecycle get` prints."""

from __future__ import annotations

import click

from rmw_manycore_py.cli.common.options import examples, json_option, platform_option
from rmw_manycore_py.cli.common.printing import print_json
from rmw_manycore_py.cli.common.tool_node import tool_node
from rmw_manycore_py.cli.lifecycle.services import (
    Lifecycle,
    existing_lifecycle_node,
    lifecycle_nodes,
)


@click.command("get", epilog=examples("manycore lifecycle get", "manycore lifecycle get /camera"))
@click.argument("node", required=False)
@json_option
@platform_option
def command(node: str | None, platform: str, as_json: bool) -> None:
    """Print the state of NODE, or of all nodes with a lifecycle."""
    names = [existing_lifecycle_node(platform, node)] if node else lifecycle_nodes(platform)
    with tool_node(platform) as tool:
        states = {name: Lifecycle(tool, name).state() for name in names}
    if as_json:
        print_json({name: {"id": s.id, "label": s.label} for name, s in states.items()})
        return
    for name, state in states.items():
        click.echo(("" if node else f"{name}: ") + f"{state.label} [{state.id}]")
