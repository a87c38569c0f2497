# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""`manycore component types`, with the output format of `ros2 component types`."""

from __future__ import annotations

import click

from rmw_manycore_py.cli.common.options import examples, json_option
from rmw_manycore_py.cli.common.printing import echo, print_json
from rmw_manycore_py.cli.component.registered import component_types, packages_with_components
from rmw_manycore_py.cli.component.wanted_options import complete_component_packages
from rmw_manycore_py.errors import ManycoreError
from rmw_manycore_py.errors.suggestions import did_you_mean
from rmw_manycore_py.ros.ament import package_prefix


@click.command("types", epilog=examples("manycore component types"))
@click.argument("package", required=False, shell_complete=complete_component_packages)
@json_option
def command(package: str | None, as_json: bool) -> None:
    """List the registered component types.

    Of all packages, or only of PACKAGE.
    """
    if package and package_prefix(package) is None:
        meant = did_you_mean(package, packages_with_components())
        raise ManycoreError(f"Unable to find package '{package}'{meant}")
    names = [package] if package else packages_with_components()
    found = {name: component_types(name) for name in names}
    if as_json:
        print_json(found)
        return
    for name, types in found.items():
        if not package:
            echo(name)
        for type_name in types:
            echo(type_name if package else f"  {type_name}")
