# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""`manycore lifecycle list`, with the output format of `ros2 lifecycle list`."""

from __future__ import annotations

import click

from rmw_manycore_py.cli.common.message_text import to_plain
from rmw_manycore_py.cli.common.options import (
    examples,
    json_option,
    named_node_options,
    platform_option,
)
from rmw_manycore_py.cli.common.printing import echo, print_json
from rmw_manycore_py.cli.common.tool_node import tool_node
from rmw_manycore_py.cli.lifecycle.services import (
    Lifecycle,
    complete_lifecycle_nodes,
    existing_lifecycle_node,
)


@click.command("list", epilog=examples("manycore lifecycle list /camera"))
@click.argument("node", shell_complete=complete_lifecycle_nodes)
@click.option(
    "-a", "--all", "every", is_flag=True, help="Also list the transitions of all other states."
)
@json_option
@named_node_options
@platform_option
def command(node: str, every: bool, platform: str, as_json: bool) -> None:
    """List the transitions that NODE can make now."""
    name = existing_lifecycle_node(platform, node)
    with tool_node(platform) as tool:
        transitions = Lifecycle(tool, name).transitions(every=every)
    if as_json:
        print_json([to_plain(transition) for transition in transitions])
        return
    for found in transitions:
        echo(
            f"- {found.transition.label} [{found.transition.id}]\n"
            f"\tStart: {found.start_state.label}\n"
            f"\tGoal: {found.goal_state.label}"
        )
