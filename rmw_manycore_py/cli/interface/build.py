# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""`manycore interface build`."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping
from pathlib import Path

import click
from rich.console import Console

from rmw_manycore_py.cli.common.options import examples
from rmw_manycore_py.cli.common.printing import counted, echo, print_notices
from rmw_manycore_py.errors import EXIT_BAD_INPUT, ManycoreError
from rmw_manycore_py.interfaces.build import Listener, Outcome, build
from rmw_manycore_py.interfaces.selection import Part
from rmw_manycore_py.interfaces.sources import Source, find_sources
from rmw_manycore_py.mapfile import load_mapfile
from rmw_manycore_py.mapfile.installed import find_mapfile
from rmw_manycore_py.mapfile.placing.used_types import used_types
from rmw_manycore_py.ros import ament


@click.command(
    "build",
    epilog=examples(
        "manycore interface build ~/ros2_ws/src",
        "manycore interface build src/nav2_msgs --only nav2_msgs/action/NavigateToPose",
        "manycore interface build src --mapfile robot.yaml",
    ),
)
@click.argument("paths", metavar="PATH...", nargs=-1, required=True, type=Path)
@click.option(
    "--only", metavar="TYPE", multiple=True, help="Build only this type and the types it uses."
)
@click.option("--mapfile", metavar="MAP", help="Build only types that the nodes of MAP use.")
def command(paths: tuple[Path, ...], only: tuple[str, ...], mapfile: str | None) -> None:
    """Build the interface packages found in each PATH.

    For this user's Python programs. PATH is a ROS 2 package, a directory pkg/{msg,srv,action},
    or a directory that contains such.
    """
    sources = find_sources(paths)
    wanted = {*only, *(_used_by(mapfile, sources) if mapfile else ())}
    console = Console(stderr=True)
    with console.status("") as status:

        def on_progress(package: str, text: str) -> None:
            status.update(f"{package}: {text}")

        def on_wait() -> None:
            console.print("waiting for another build to finish")

        outcomes = build(sources, wanted, Listener(on_wait, on_progress, _print_outcome))
    print_notices(_not_used(outcomes))


def _used_by(name: str, sources: Mapping[str, Source]) -> set[str]:
    """Return the types in the sources that the nodes of a mapfile use."""
    file = find_mapfile(name)
    if file is None:
        raise ManycoreError(f"--mapfile {name}: expected a mapfile, found no file", EXIT_BAD_INPUT)
    used = used_types(load_mapfile(file))
    wanted = {name for name in used if name.split("/")[0] in sources}
    if not wanted:
        packages = ", ".join(sources)
        raise ManycoreError(
            f"{file}: expected nodes that use types of {packages}, found none", EXIT_BAD_INPUT
        )
    for type_name in sorted(wanted):
        source = sources[type_name.split("/")[0]]
        if type_name not in source.definitions:
            raise ManycoreError(
                f"{file}: its nodes use {type_name}, which {source.directory} does not define",
                EXIT_BAD_INPUT,
            )
    return wanted


def _print_outcome(outcome: Outcome) -> None:
    part, manifest = outcome.part, outcome.manifest
    number = counted(len(part.definitions), "definition")
    time = f" in {manifest.seconds:g} s" if outcome.is_new else ", built before"
    echo(f"{part.package}: {number}{time}{_saving(part)}")


def _saving(part: Part) -> str:
    if part.is_whole:
        return ""
    left_out = part.available - len(part.definitions)
    return f"; left out {left_out} of {part.available}, {1 - part.share_of_code:.0%} of the code"


def _not_used(outcomes: Iterable[Outcome]) -> Iterator[str]:
    for outcome in outcomes:
        package = outcome.part.package
        if ament.is_installed(package):
            place = ament.package_share(package)
            yield f"programs use the '{package}' that is installed ({place}), not the one built"
