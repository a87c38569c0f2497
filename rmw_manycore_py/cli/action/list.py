# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""`manycore action list`, with the output format of `ros2 action list`."""

from __future__ import annotations

import click

from rmw_manycore_py.cli.common import view
from rmw_manycore_py.cli.common.names import show_names
from rmw_manycore_py.cli.common.options import (
    count_option,
    examples,
    json_option,
    platform_option,
    types_option,
)


@click.command("list", epilog=examples("manycore action list -t", "manycore action list --json"))
@types_option
@count_option
@json_option
@platform_option
def command(platform: str, as_json: bool, show_types: bool, count: bool) -> None:
    """List the actions of a platform.

    Actions that only have clients are listed as well.
    """
    rows = view.actions(view.endpoints_on(platform))
    show_names(rows, as_json=as_json, types=show_types, count=count)
