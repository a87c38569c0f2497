# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""`manycore interface packages`, with the output format of `ros2 interface packages`."""

from __future__ import annotations

import click

from rmw_manycore_py.cli.common.options import examples, json_option
from rmw_manycore_py.cli.common.printing import echo, print_json
from rmw_manycore_py.cli.interface.kinds import kind_options, of_kinds
from rmw_manycore_py.ros.ament import interfaces, packages_with_interfaces


@click.command("packages", epilog=examples("manycore interface packages --only-actions"))
@kind_options
@json_option
def command(kinds: tuple[str, ...], as_json: bool) -> None:
    """List the packages that define types."""
    names = [name for name in packages_with_interfaces() if any(of_kinds(interfaces(name), kinds))]
    if as_json:
        print_json(names)
        return
    for name in names:
        echo(name)
