# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""`manycore interface show`, printed as `ros2 interface show` prints."""

from __future__ import annotations

import click

from rmw_manycore_py.cli.common.options import examples
from rmw_manycore_py.cli.interface.text import definition


@click.command("show", epilog=examples("manycore interface show sensor_msgs/msg/PointCloud2"))
@click.argument("type_name", metavar="TYPE")
@click.option("--all-comments", is_flag=True, help="Show the comments of nested types too.")
@click.option("--no-comments", is_flag=True, help="Show no comments and no empty lines.")
def command(type_name: str, all_comments: bool, no_comments: bool) -> None:
    """Show the definition of TYPE, with the types in it."""
    for line in definition(type_name, comments=not no_comments, nested_comments=all_comments):
        click.echo(line)
