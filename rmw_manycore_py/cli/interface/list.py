# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""`manycore interface list`, with the output format of `ros2 interface list`."""

from __future__ import annotations

import click

from rmw_manycore_py.cli.common.options import examples, json_option
from rmw_manycore_py.cli.common.printing import echo, print_json
from rmw_manycore_py.cli.interface.built import print_built
from rmw_manycore_py.cli.interface.kinds import TITLES, kind_of, kind_options
from rmw_manycore_py.ros.ament import interfaces, packages_with_interfaces


@click.command(
    "list", epilog=examples("manycore interface list -s", "manycore interface list --built")
)
@kind_options
@click.option(
    "--built", is_flag=True, help="List locally built packages, and which version programs use."
)
@json_option
def command(kinds: tuple[str, ...], built: bool, as_json: bool) -> None:
    """List the installed and locally built types.

    By default of all three kinds.
    """
    if built:
        print_built(kinds, as_json)
        return
    names = sorted(name for package in packages_with_interfaces() for name in interfaces(package))
    found = {
        kind: [name for name in names if kind_of(name) == kind]
        for kind in TITLES
        if not kinds or kind in kinds
    }
    if as_json:
        print_json(found)
        return
    for kind, of_kind in found.items():
        echo(f"{TITLES[kind]}:")
        for name in of_kind:
            echo(f"    {name}")
