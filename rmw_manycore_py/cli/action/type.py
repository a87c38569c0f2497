# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""`manycore action type`, with the output format of `ros2 action type`."""

from __future__ import annotations

import click

from rmw_manycore_py.cli.common import view
from rmw_manycore_py.cli.common.completion import complete_actions
from rmw_manycore_py.cli.common.names import show_types
from rmw_manycore_py.cli.common.options import examples, platform_option


@click.command("type", epilog=examples("manycore action type /fibonacci"))
@click.argument("action", shell_complete=complete_actions)
@platform_option
def command(action: str, platform: str) -> None:
    """Print the type of ACTION."""
    show_types(view.actions(view.endpoints_on(platform)), action, "action")
