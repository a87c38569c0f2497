# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""`manycore up`."""

from __future__ import annotations

import sys
from pathlib import Path

import click

from rmw_manycore_py.cli.common.mapfile_argument import mapfile_argument
from rmw_manycore_py.cli.common.node_watch import NodeWatch, checked_answer
from rmw_manycore_py.cli.common.options import examples
from rmw_manycore_py.cli.common.printed_run import print_run
from rmw_manycore_py.cli.common.printing import echo, print_notices
from rmw_manycore_py.cli.common.run_printer import RunPrinter
from rmw_manycore_py.cli.common.starting import prepared_run, starting_options
from rmw_manycore_py.errors import EXIT_BAD_INPUT, ManycoreError
from rmw_manycore_py.launch.detached import run_in_background
from rmw_manycore_py.launch.runs.client import Client
from rmw_manycore_py.launch.runs.directory import RunDirectory, all_runs
from rmw_manycore_py.mapfile import load_mapfile
from rmw_manycore_py.ros.domain import default_platform


@click.command(
    "up",
    epilog=examples(
        "manycore up -d talker_listener",
        "manycore logs -f talker",
        "manycore up -d more_nodes.yaml --join",
        "manycore stop",
    ),
)
@mapfile_argument()
@click.option("-d", "--detach", "detached", is_flag=True, help="Run in the background.")
@starting_options
def command(
    mapfile: Path, detached: bool, joins: bool, nodes: tuple[str, ...], host: str | None
) -> None:
    """Start MAPFILE, or apply its changes to a run.

    Without -d, like `manycore run`, which has more options. With -d, returns once all nodes are
    started; Ctrl-C before that stops them again. Continue with ps, logs, restart, move, attach and
    stop.

    If MAPFILE runs already, -d applies what has changed in it: nodes that are new, or have another
    place or definition, are started there, and nodes that are gone are stopped. Others run on.
    Shape, topics and bridge of a running platform cannot change: then nothing is applied.
    """
    if detached and not joins and not nodes and (running := _run_of(mapfile)):
        _check_host(running, host)
        sys.exit(_apply(running))
    run, placement = prepared_run(mapfile, joins, nodes, detached, host=host)
    printer = RunPrinter(run.program_names)
    if not detached:
        sys.exit(print_run(run, printer.report))
    status = run_in_background(run, printer.report)
    if status == 0:
        option = "" if placement.name == default_platform() else f" --platform {placement.name}"
        printer.print_line(f"in the background: manycore logs -f{option}; manycore stop{option}")
    sys.exit(status)


def _run_of(mapfile: Path) -> RunDirectory | None:
    """Return the run of a mapfile on its platform, or on the one that it named before."""
    loaded, path = load_mapfile(mapfile), str(mapfile.resolve())
    name, is_named = loaded.platform_name, loaded.sections.platform.name is not None
    renamed = None
    for run in all_runs():
        info = run.info
        if not run.is_alive or info.get("mapfile") != path:
            continue
        if run.platform == name:
            return run
        # Names from the environment are of several platforms at a time.
        if (is_named or info.get("names_platform")) and not info.get("joins"):
            renamed = renamed or run
    return renamed


def _check_host(run: RunDirectory, host: str | None) -> None:
    """Raise ManycoreError if the run is of another part of its mapfile."""
    running = run.info.get("host")
    if running != host:
        raise ManycoreError(
            f"platform '{run.platform}' runs {_part(running)} of {run.info.get('mapfile')}, not "
            f"{_part(host)}; `manycore stop --platform {run.platform}` stops it",
            EXIT_BAD_INPUT,
        )


def _part(host: str | None) -> str:
    return f"the part of host '{host}'" if host else "the whole"


def _apply(run: RunDirectory) -> int:
    """Apply what has changed in the mapfile of a run; return the exit status."""
    with Client(run, "apply") as client:
        answer = checked_answer(client)
        print_notices(
            f"{name} is unchanged, and has ended: `manycore restart {name}` starts it"
            for name in answer["stay_ended"]
        )
        if not answer["starts"] and not answer["ends"]:
            echo(f"{run.info['mapfile']} runs already on platform {run.platform}, unchanged")
            return 0
        return NodeWatch(run, answer["starts"], answer["ends"]).follow(client)
