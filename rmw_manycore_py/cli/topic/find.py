# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""`manycore topic find`, with the output format of `ros2 topic find`."""

from __future__ import annotations

import click

from rmw_manycore_py.cli.common import view
from rmw_manycore_py.cli.common.completion import complete_message_types
from rmw_manycore_py.cli.common.names import show_names
from rmw_manycore_py.cli.common.options import (
    count_option,
    discovery_options,
    examples,
    hidden_option,
    json_option,
    platform_option,
)


@click.command("find", epilog=examples("manycore topic find std_msgs/msg/String"))
@click.argument("type_name", metavar="TYPE", shell_complete=complete_message_types)
@count_option
@hidden_option
@discovery_options
@json_option
@platform_option
def command(type_name: str, platform: str, as_json: bool, hidden: bool, count: bool) -> None:
    """List the topics of TYPE."""
    rows = view.topics(view.endpoints_on(platform), hidden=hidden)
    rows = [row for row in rows if type_name in row["types"]]
    show_names(rows, as_json=as_json, count=count)
