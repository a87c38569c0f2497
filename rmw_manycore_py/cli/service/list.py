# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""`manycore service list`, with the output format of `ros2 service list`."""

from __future__ import annotations

import click

from rmw_manycore_py.cli.common import view
from rmw_manycore_py.cli.common.names import show_names
from rmw_manycore_py.cli.common.options import examples, listing_options, types_option


@click.command("list", epilog=examples("manycore service list -t", "manycore service list --json"))
@types_option
@listing_options
def command(platform: str, as_json: bool, show_types: bool, count: bool, hidden: bool) -> None:
    """List the services of a platform.

    Services that only have clients are listed as well.
    """
    rows = view.services(view.endpoints_on(platform), hidden=hidden)
    show_names(rows, as_json=as_json, types=show_types, count=count)
