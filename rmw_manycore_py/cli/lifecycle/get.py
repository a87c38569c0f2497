# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""`manycore lifecycle get`, with the output format of `ros2 lifecycle get`."""

from __future__ import annotations

import click

from rmw_manycore_py.cli.common.options import (
    discovery_options,
    examples,
    hidden_option,
    json_option,
    platform_option,
)
from rmw_manycore_py.cli.common.printing import echo, escaped, print_json
from rmw_manycore_py.cli.common.tool_node import tool_node
from rmw_manycore_py.cli.lifecycle.services import (
    Lifecycle,
    complete_lifecycle_nodes,
    existing_lifecycle_node,
    lifecycle_nodes,
)
from rmw_manycore_py.ros.names import is_hidden


@click.command("get", epilog=examples("manycore lifecycle get", "manycore lifecycle get /camera"))
@click.argument("node", required=False, shell_complete=complete_lifecycle_nodes)
@json_option
@hidden_option
@discovery_options
@platform_option
def command(node: str | None, platform: str, as_json: bool, hidden: bool) -> None:
    """Print the state of NODE or of all lifecycle nodes."""
    if node:
        names = [existing_lifecycle_node(platform, node)]
    else:
        found = lifecycle_nodes(platform)
        names = [name for name in found if hidden or not is_hidden(name)]
    with tool_node(platform) as tool:
        states = {name: Lifecycle(tool, name).state() for name in names}
    if as_json:
        print_json({name: {"id": s.id, "label": s.label} for name, s in states.items()})
        return
    for name, state in states.items():
        echo(escaped(("" if node else f"{name}: ") + f"{state.label} [{state.id}]"))
