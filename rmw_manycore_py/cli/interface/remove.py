# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""`manycore interface remove`."""

from __future__ import annotations

import click

from rmw_manycore_py.cli.common.options import examples
from rmw_manycore_py.cli.common.printing import echo
from rmw_manycore_py.interfaces.build import remove


@click.command("remove", epilog=examples("manycore interface remove nav2_msgs"))
@click.argument("packages", metavar="PACKAGE...", nargs=-1, required=True)
def command(packages: tuple[str, ...]) -> None:
    """Remove packages built by `interface build`."""
    remove(packages, lambda: echo("waiting for a build to finish", err=True))
    for package in packages:
        echo(f"{package}: removed")
