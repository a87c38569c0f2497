# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""`manycore clean`."""

from __future__ import annotations

import click

from rmw_manycore_py import _transport
from rmw_manycore_py.cli.common.options import examples, json_option
from rmw_manycore_py.cli.common.printing import print_json
from rmw_manycore_py.cli.common.view import platform_names
from rmw_manycore_py.emcos.memory import remove_names_of_the_dead
from rmw_manycore_py.errors import ManycoreError
from rmw_manycore_py.ros.domain import checked_platform
from rmw_manycore_py.runs.directory import remove_ended, runs_of


@click.command("clean", epilog=examples("manycore clean", "manycore clean --logs domain-0"))
@click.argument("platforms", nargs=-1)
@click.option("--logs", is_flag=True, help="Also remove the logs of runs that have ended.")
@json_option
def command(platforms: tuple[str, ...], logs: bool, as_json: bool) -> None:
    """Remove what dead PLATFORMS left in shared memory; by default, all dead platforms.

    Leaves live platforms alone. The next start of a platform does the same.
    """
    removed: list[str] = []
    known = platform_names()
    for name in platforms or known:
        if checked_platform(name, "PLATFORMS") not in known:
            if logs and runs_of(name):
                continue
            raise ManycoreError(f"no platform '{name}'")
        try:
            removed += _transport.clean(name)
        except _transport.PlatformError as error:
            if platforms:
                raise ManycoreError(str(error)) from error
    if not platforms:
        removed += remove_names_of_the_dead()
    if logs:
        removed += [str(path) for name in platforms or (None,) for path in remove_ended(name)]
    if as_json:
        print_json({"removed": removed})
        return
    for path in removed:
        click.echo(path)
