# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""`manycore env`."""

from __future__ import annotations

import shlex

import click

from rmw_manycore_hook import AMENT_PREFIX_PATH, LIBRARY_PATH, WHEELS_BOOTSTRAPPED
from rmw_manycore_py.cli.common.options import examples, json_option
from rmw_manycore_py.cli.common.printing import print_json
from rmw_manycore_py.launch.processes.environment import program_environment

VARIABLES = ("RMW_IMPLEMENTATION", LIBRARY_PATH, WHEELS_BOOTSTRAPPED, AMENT_PREFIX_PATH)


@click.command("env", epilog=examples('eval "$(manycore env)"', "python talker.py"))
@json_option
def command(as_json: bool) -> None:
    """Print the environment for ROS 2 programs.

    It makes the programs of a shell use rmw_manycore. Programs of this Python only need
    RMW_IMPLEMENTATION; the other variables are for other languages, and for ROS 2 from apt.
    """
    wanted = program_environment({})
    names = [name for name in VARIABLES if name in wanted]
    if as_json:
        print_json({name: wanted[name] for name in names})
        return
    for name in names:
        click.echo(f"export {name}={shlex.quote(wanted[name])}")
