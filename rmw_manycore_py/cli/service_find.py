# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""`manycore service find`, printed as `ros2 service find` prints."""

from __future__ import annotations

import click

from rmw_manycore_py.cli import view
from rmw_manycore_py.cli.names import show_names
from rmw_manycore_py.cli.options import examples, hidden_option, json_option, platform_option


@click.command("find", epilog=examples("manycore service find std_srvs/srv/SetBool"))
@click.argument("type_name", metavar="TYPE")
@hidden_option
@json_option
@platform_option
def command(type_name: str, platform: str, as_json: bool, hidden: bool) -> None:
    """List the services of TYPE."""
    rows = view.services(view.open_platform(platform).endpoints(), hidden=hidden)
    show_names([row for row in rows if type_name in row["types"]], as_json=as_json)
