# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""`manycore run`."""

from __future__ import annotations

import sys
from pathlib import Path
from typing import Any

import click

from rmw_manycore_py.cli.common.duration import duration_option
from rmw_manycore_py.cli.common.mapfile_argument import mapfile_argument
from rmw_manycore_py.cli.common.options import examples
from rmw_manycore_py.cli.common.output_file import OutputFile
from rmw_manycore_py.cli.common.printed_run import print_run
from rmw_manycore_py.cli.common.printing import echo
from rmw_manycore_py.cli.common.run_printer import RunPrinter
from rmw_manycore_py.cli.common.starting import (
    prepared_run,
    starting_options,
    virtual_options,
    virtual_time,
)
from rmw_manycore_py.launch.events import Event
from rmw_manycore_py.trace.atomic_file import require_writable
from rmw_manycore_py.trace.formats import SUFFIXES, require_format


@click.command(
    "run",
    epilog=examples(
        "manycore run my_map.yaml",
        "manycore run talker_listener --duration 10",
        "manycore run more_nodes.yaml --join",
        "manycore run robot.yaml --host laptop",
        "manycore run talker_listener --duration 10 --trace trace.json",
        "manycore run talker_listener --virtual --instant --duration 60",
        "manycore run map.yaml --virtual --instant --kill planner@12.5",
        "manycore run whill --profile whill.profile.json --platform coolidge --duration 60",
        "manycore run talker_listener --json | jq 'select(.event == \"output\")'",
    ),
)
@mapfile_argument()
@duration_option()
@starting_options
@virtual_options
@click.option("--json", "as_json", is_flag=True, help="Print one JSON object per event.")
@click.option(
    "--trace",
    type=OutputFile(*SUFFIXES),
    help="Trace the whole run to FILE: .json, .csv or .pftrace.",
)
def command(
    mapfile: Path,
    duration_s: float | None,
    joins: bool,
    nodes: tuple[str, ...],
    host: str | None,
    as_json: bool,
    trace: Path | None,
    **virtual: Any,
) -> None:
    """Run the nodes of MAPFILE, each on its core.

    Ctrl-C stops them together. MAPFILE is a path, or the name of an installed mapfile (manycore
    demo --list). The run ends when all nodes have ended, after --duration, or on Ctrl-C; a
    second Ctrl-C does not wait for slow nodes. The exit status is non-zero if a node failed. To
    run in the background, use manycore up -d.

    In virtual time a run may take less time than --duration. With --instant it is repeatable.
    """
    if trace is not None:
        require_format(trace)
        require_writable(trace)
    time = virtual_time(mapfile, **virtual)
    run, _ = prepared_run(mapfile, joins, nodes, virtual=time, host=host)
    report = _print_json if as_json else RunPrinter(run.program_names).report
    sys.exit(print_run(run, report, duration_s, trace=trace))


def _print_json(event: Event) -> None:
    echo(event.as_json())
