# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""`manycore service info`, with the output format of `ros2 service info`."""

from __future__ import annotations

import click

from rmw_manycore_py.cli.common import view
from rmw_manycore_py.cli.common.completion import complete_services
from rmw_manycore_py.cli.common.names import row_of
from rmw_manycore_py.cli.common.options import examples, graph_options
from rmw_manycore_py.cli.common.printing import echo, escaped, print_json


@click.command("info", epilog=examples("manycore service info /switch_lamp"))
@click.argument("service", shell_complete=complete_services)
@graph_options
def command(service: str, platform: str, as_json: bool) -> None:
    """Show the number of servers and clients of SERVICE."""
    rows = view.services(view.endpoints_on(platform), hidden=True)
    row = row_of(rows, service, "service")
    if as_json:
        print_json(row)
        return
    types = row["types"]
    echo(escaped(f"Type: {types[0] if len(types) == 1 else types}"))
    echo(f"Clients count: {row['clients']}")
    echo(f"Services count: {row['servers']}")
