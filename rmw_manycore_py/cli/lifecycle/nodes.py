# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""`manycore lifecycle nodes`, with the output format of `ros2 lifecycle nodes`."""

from __future__ import annotations

import click

from rmw_manycore_py.cli.common.options import examples, listing_options
from rmw_manycore_py.cli.common.printing import echo, escaped, print_json
from rmw_manycore_py.cli.lifecycle.services import lifecycle_nodes
from rmw_manycore_py.ros.names import is_hidden


@click.command("nodes", epilog=examples("manycore lifecycle nodes"))
@click.option("-a", "--all", "everything", is_flag=True, help="Same as --include-hidden.")
@listing_options
def command(platform: str, count: bool, hidden: bool, everything: bool, as_json: bool) -> None:
    """List the lifecycle nodes."""
    found = lifecycle_nodes(platform)
    names = [name for name in found if hidden or everything or not is_hidden(name)]
    if as_json:
        print_json(names)
    elif count:
        echo(len(names))
    else:
        for name in names:
            echo(escaped(name))
