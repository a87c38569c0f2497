# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""`manycore node info`, with the output format of `ros2 node info`."""

from __future__ import annotations

import click

from rmw_manycore_py.cli.common import view
from rmw_manycore_py.cli.common.completion import complete_nodes
from rmw_manycore_py.cli.common.node_names import existing_node
from rmw_manycore_py.cli.common.options import examples, graph_options, hidden_option
from rmw_manycore_py.cli.common.printing import echo, escaped, print_json


@click.command("info", epilog=examples("manycore node info /talker"))
@click.argument("node", shell_complete=complete_nodes)
@hidden_option
@graph_options
def command(node: str, platform: str, as_json: bool, hidden: bool) -> None:
    """Show the topics, services and actions of NODE."""
    node = existing_node(platform, node)
    interfaces = view.node_interfaces(view.endpoints_on(platform), node, hidden=hidden)
    if as_json:
        print_json({"node": node, **interfaces})
        return
    echo(escaped(node))
    for kind, entries in interfaces.items():
        echo(f"  {kind.replace('_', ' ').title()}:")
        for name, type_name in entries.items():
            echo(f"    {escaped(name)}: {escaped(type_name)}")
        if not entries:
            echo()
