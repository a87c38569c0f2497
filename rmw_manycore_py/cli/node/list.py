# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""`manycore node list`, with the output format of `ros2 node list`."""

from __future__ import annotations

import click

from rmw_manycore_py.cli.common import view
from rmw_manycore_py.cli.common.options import examples, listing_options
from rmw_manycore_py.cli.common.printing import echo, escaped, print_json

SHARED_NAME = (
    "WARNING: Be aware that there are nodes in the graph that share an exact name, which can have "
    "unintended side effects."
)


@click.command("list", epilog=examples("manycore node list", "manycore node list --json"))
@click.option("-a", "--all", "everything", is_flag=True, help="Same as --include-hidden.")
@listing_options
def command(platform: str, as_json: bool, hidden: bool, everything: bool, count: bool) -> None:
    """List the nodes of a platform."""
    with view.open_platform(platform) as opened:
        nodes, processes = opened.nodes(), opened.processes()
    names = view.node_names(nodes, hidden=hidden or everything)
    if as_json:
        print_json(view.placed_nodes(nodes, processes, set(names)))
        return
    if len(set(names)) < len(names) and not count:
        echo(SHARED_NAME, err=True)
    for name in [len(names)] if count else names:
        echo(escaped(str(name)))
