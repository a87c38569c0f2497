# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""`manycore up`."""

from __future__ import annotations

import sys
from pathlib import Path

import click

from rmw_manycore_py.cli.common.mapfile_argument import mapfile_argument
from rmw_manycore_py.cli.common.options import examples
from rmw_manycore_py.cli.common.run_printer import RunPrinter
from rmw_manycore_py.cli.common.starting import prepared_run, starting_options
from rmw_manycore_py.launch.detached import run_in_background
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
def command(mapfile: Path, detached: bool, joins: bool, nodes: tuple[str, ...]) -> None:
    """Start the nodes of MAPFILE; -d: in the background.

    Without -d, same as `manycore run`. With -d, returns once all nodes are started; Ctrl-C before
    that stops them again. Continue with ps, logs, restart, attach and stop.
    """
    run, placement = prepared_run(mapfile, joins, nodes, detached)
    printer = RunPrinter(run.program_names)
    if not detached:
        sys.exit(run.run(printer.report))
    status = run_in_background(run, printer.report)
    if status == 0:
        option = "" if placement.name == default_platform() else f" --platform {placement.name}"
        printer.say(f"in the background: manycore logs -f{option}; manycore stop{option}")
    sys.exit(status)
