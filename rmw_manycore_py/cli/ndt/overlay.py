# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""`manycore ndt overlay`."""

from __future__ import annotations

from pathlib import Path

import click

from rmw_manycore_py.autoware_overlay import PACKAGE, write_overlay
from rmw_manycore_py.cli.common.options import examples
from rmw_manycore_py.cli.common.output_file import writing


@click.command(
    "overlay",
    epilog=examples("manycore ndt overlay ~/ndt_overlay && . ~/ndt_overlay/setup.sh"),
)
@click.argument("directory", type=click.Path(file_okay=False, path_type=Path))
def command(directory: Path) -> None:
    """Let this scan matcher stand in the place of Autoware's, in shells that source DIRECTORY.

    DIRECTORY becomes an install prefix with a package of Autoware's name, whose executable starts
    the node of rmw_manycore. Launch and parameter files are those of the Autoware that is sourced.
    """
    if not directory.parent.is_dir():
        raise click.UsageError(f"'{directory}': there is no directory '{directory.parent}'")
    with writing(directory):
        stock = write_overlay(directory)
    files = f"launch and parameter files of {stock}" if stock else "no Autoware is sourced"
    click.echo(f"{directory}: {PACKAGE} ({files})")
    click.echo(f". {directory}/setup.sh")
