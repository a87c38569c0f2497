# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""`manycore action info`, with the output format of `ros2 action info`."""

from __future__ import annotations

import click

from rmw_manycore_py.cli.common import view
from rmw_manycore_py.cli.common.completion import complete_actions
from rmw_manycore_py.cli.common.names import row_of
from rmw_manycore_py.cli.common.options import (
    count_option,
    examples,
    json_option,
    platform_option,
    types_option,
)
from rmw_manycore_py.cli.common.printing import echo, escaped, print_json


@click.command("info", epilog=examples("manycore action info -t /fibonacci"))
@click.argument("action", shell_complete=complete_actions)
@types_option
@count_option
@json_option
@platform_option
def command(action: str, platform: str, as_json: bool, show_types: bool, count: bool) -> None:
    """Show the servers and clients of ACTION."""
    row = row_of(view.actions(view.endpoints_on(platform)), action, "action")
    if as_json:
        print_json(row)
        return
    echo(escaped(f"Action: {action}"))
    for role in ("clients", "servers"):
        echo(f"Action {role}: {len(row[role])}")
        for end in [] if count else row[role]:
            node, of_type = escaped(end["node"]), escaped(f" [{end['type']}]")
            echo(f"    {node}" + (of_type if show_types else ""))
