# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""`manycore interface package`, with the output format of `ros2 interface package`."""

from __future__ import annotations

import click

from rmw_manycore_py.cli.common.completion import complete_packages
from rmw_manycore_py.cli.common.options import examples, json_option
from rmw_manycore_py.cli.common.printing import echo, print_json
from rmw_manycore_py.cli.interface.kinds import kind_options, of_kinds
from rmw_manycore_py.errors import ManycoreError
from rmw_manycore_py.errors.suggestions import did_you_mean
from rmw_manycore_py.ros.ament import interfaces, packages_with_interfaces


@click.command("package", epilog=examples("manycore interface package std_srvs"))
@click.argument("package", shell_complete=complete_packages)
@kind_options
@json_option
def command(package: str, kinds: tuple[str, ...], as_json: bool) -> None:
    """List the types of PACKAGE."""
    names = sorted(of_kinds(interfaces(package), kinds))
    if not interfaces(package):
        meant = did_you_mean(package, packages_with_interfaces())
        raise ManycoreError(
            f"Unknown package '{package}'" + (meant or ": it is not installed or defines no types")
        )
    if as_json:
        print_json(names)
        return
    for name in names:
        echo(name)
