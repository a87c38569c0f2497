# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""`manycore ndt overlay`."""

from __future__ import annotations

from pathlib import Path

import click

from rmw_manycore_py.cli.common.options import examples
from rmw_manycore_py.cli.common.output_file import writing
from rmw_manycore_py.cli.common.printing import echo
from rmw_manycore_py.ndt.autoware_overlay import MAP_LOADER, MATCHER, write_overlay


@click.command(
    "overlay",
    epilog=examples(
        "manycore ndt overlay ~/ndt_overlay && . ~/ndt_overlay/setup.sh",
        "manycore ndt overlay ~/ndt_overlay --map-loader",
    ),
)
@click.argument("directory", type=click.Path(file_okay=False, path_type=Path))
@click.option("--map-loader", is_flag=True, help="Also replace Autoware's pointcloud_map_loader.")
def command(directory: Path, map_loader: bool) -> None:
    """Replace Autoware's scan matcher in a shell.

    Shells that source DIRECTORY/setup.sh start this one instead. DIRECTORY becomes an install
    prefix with a package of Autoware's name, whose executable starts the node of rmw_manycore.
    Launch and parameter files are taken from the sourced Autoware.
    """
    if not directory.parent.is_dir():
        raise click.UsageError(f"'{directory}': there is no directory '{directory.parent}'")
    with writing(directory):
        found = write_overlay(directory, (MATCHER, MAP_LOADER) if map_loader else (MATCHER,))
    for package, stock in found.items():
        files = f"launch and parameter files of {stock}" if stock else "no Autoware is sourced"
        echo(f"{directory}: {package} ({files})")
    echo(f". {directory}/setup.sh")
