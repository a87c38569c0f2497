# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""`manycore env`."""

from __future__ import annotations

import os
import shlex

import click

from rmw_manycore_py.cli.options import examples, json_option, print_json
from rmw_manycore_py.launch.environment import program_environment


@click.command("env", epilog=examples('eval "$(manycore env)"', "python talker.py"))
@json_option
def command(as_json: bool) -> None:
    """Print what a shell exports so that its ROS 2 programs use rmw_manycore.

    Python programs need RMW_IMPLEMENTATION alone; the rest is for programs in other languages.
    """
    wanted = program_environment({})
    changed = {name: value for name, value in wanted.items() if os.environ.get(name) != value}
    changed["RMW_IMPLEMENTATION"] = wanted["RMW_IMPLEMENTATION"]  # what one looks for first
    if as_json:
        print_json(changed)
        return
    for name, value in sorted(changed.items()):
        click.echo(f"export {name}={shlex.quote(value)}")
