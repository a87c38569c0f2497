# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""`manycore run`."""

from __future__ import annotations

import math
import sys
from pathlib import Path

import click

from rmw_manycore_py.cli.common.options import examples, mapfile_argument
from rmw_manycore_py.cli.common.run_printer import RunPrinter
from rmw_manycore_py.launch.events import Event
from rmw_manycore_py.launch.run import Run
from rmw_manycore_py.mapfile import load_mapfile, resolve


def _number(_context: click.Context, _option: click.Parameter, value: float | None) -> float | None:
    if value is not None and math.isnan(value):
        raise click.BadParameter("nan is not a number of seconds.")
    return value


@click.command(
    "run",
    epilog=examples(
        "manycore run mapfiles/talker_listener.yaml",
        "manycore run mapfiles/talker_listener.yaml --duration 10",
        "manycore run mapfiles/talker_listener.yaml --json | jq 'select(.event == \"output\")'",
    ),
)
@mapfile_argument
@click.option(
    "--duration",
    "duration_s",
    type=click.FloatRange(min=0, min_open=True),
    metavar="S",
    callback=_number,
    help="Stop after this many seconds, counted from the start of the last node.",
)
@click.option("--json", "as_json", is_flag=True, help="Print one JSON object per event.")
def command(mapfile: Path, duration_s: float | None, as_json: bool) -> None:
    """Start the nodes of MAPFILE, each on its core, and stop them together.

    Ends when all nodes have ended, when the duration is over, or on Ctrl-C; a second Ctrl-C does
    not wait for nodes that take their time. The exit status is 0 unless a node failed.
    """
    run = Run(resolve(load_mapfile(mapfile)))
    report = _print_json if as_json else RunPrinter(run.program_names).report
    sys.exit(run.run(report, duration_s))


def _print_json(event: Event) -> None:
    click.echo(event.as_json())
