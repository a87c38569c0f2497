# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""`manycore interface show`, with the output format of `ros2 interface show`."""

from __future__ import annotations

import sys

import click

from rmw_manycore_py.cli.common.completion import complete_types
from rmw_manycore_py.cli.common.options import examples
from rmw_manycore_py.cli.common.printing import echo
from rmw_manycore_py.cli.common.values_argument import exclude
from rmw_manycore_py.cli.interface.text import definition


@click.command(
    "show",
    epilog=examples(
        "manycore interface show sensor_msgs/msg/PointCloud2",
        "manycore topic type /chatter | manycore interface show -",
    ),
)
@click.argument("type_name", metavar="TYPE", shell_complete=complete_types)
@click.option("--all-comments", is_flag=True, help="Also show the comments of nested types.")
@click.option("--no-comments", is_flag=True, help="Omit comments and empty lines.")
def command(type_name: str, all_comments: bool, no_comments: bool) -> None:
    """Show the definition of TYPE and its nested types.

    - reads TYPE from standard input.
    """
    exclude(("--all-comments", all_comments), ("--no-comments", no_comments))
    if type_name == "-":
        type_name = sys.stdin.readline().strip()
    for line in definition(type_name, comments=not no_comments, nested_comments=all_comments):
        echo(line)
