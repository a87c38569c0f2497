# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""`manycore clean`."""

from __future__ import annotations

import click

from rmw_manycore_py.cli.common.options import examples, json_option
from rmw_manycore_py.cli.common.printing import echo, print_json, print_notices
from rmw_manycore_py.cli.common.view import platform_names
from rmw_manycore_py.emcos.memory import remove_names_of_the_dead
from rmw_manycore_py.errors import ManycoreError
from rmw_manycore_py.launch.runs.directory import remove_ended, runs_of
from rmw_manycore_py.native import _transport
from rmw_manycore_py.ros.domain import checked_platform


@click.command(
    "clean",
    epilog=examples(
        "manycore clean", "manycore clean --logs domain-0", "manycore clean --force domain-0"
    ),
)
@click.argument("platforms", nargs=-1)
@click.option("--logs", is_flag=True, help="Also remove the logs of runs that have ended.")
@click.option(
    "--force",
    is_flag=True,
    help="Also remove PLATFORMS that seem alive and have no process that is visible here.",
)
@json_option
def command(platforms: tuple[str, ...], logs: bool, force: bool, as_json: bool) -> None:
    """Remove what dead PLATFORMS left in shared memory.

    By default all dead platforms. Prints the removed files. Leaves live platforms alone, and
    fails if PLATFORMS names one. The next start of a platform does the same, unless its files
    are damaged.
    """
    if force and not platforms:
        raise click.UsageError("--force requires PLATFORMS")
    cleaned = _Cleaned()
    known = platform_names()
    for name in platforms or known:
        if checked_platform(name, "PLATFORMS") in known:
            cleaned.clean(name, force)
        elif not (logs and runs_of(name)):
            cleaned.problems.append(f"no platform '{name}'")
    if not platforms:
        cleaned.removed += remove_names_of_the_dead()
    if logs:
        cleaned.removed += [
            str(path) for name in platforms or (None,) for path in remove_ended(name)
        ]
    cleaned.show(as_json)
    if problems := cleaned.problems + (cleaned.alive if platforms else []):
        raise ManycoreError("\n".join(problems))


class _Cleaned:
    """What was removed, and why other platforms were not."""

    def __init__(self) -> None:
        self.removed: list[str] = []
        self.alive: list[str] = []
        self.problems: list[str] = []

    def clean(self, name: str, force: bool) -> None:
        """Remove a platform, or note why not."""
        try:
            self.removed += _transport.clean(name, force)
        except _transport.PlatformInUseError as error:
            self.alive.append(str(error))
        except _transport.PlatformError as error:
            self.problems.append(str(error))

    def show(self, as_json: bool) -> None:
        """Print what was removed, and to standard error which platforms are alive."""
        if as_json:
            print_json({"removed": self.removed})
            return
        for path in self.removed:
            echo(path)
        if not self.removed and not self.problems:
            echo("nothing to remove", err=True)
        print_notices(self.alive)
