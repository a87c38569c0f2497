# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""`manycore topic list`, printed as `ros2 topic list` prints."""

from __future__ import annotations

import click

from rmw_manycore_py.cli import view
from rmw_manycore_py.cli.options import (
    examples,
    hidden_option,
    json_option,
    platform_option,
    print_json,
)


@click.command("list", epilog=examples("manycore topic list -t", "manycore topic list --json"))
@click.option("-t", "--show-types", is_flag=True, help="Show the type of each topic.")
@hidden_option
@json_option
@platform_option
def command(platform: str, as_json: bool, show_types: bool, hidden: bool) -> None:
    """List the topics of a platform."""
    rows = view.topics(view.open_platform(platform).endpoints(), hidden=hidden)
    if as_json:
        print_json(rows)
        return
    for row in rows:
        click.echo(f"{row['name']} [{', '.join(row['types'])}]" if show_types else row["name"])
