# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""`manycore profile record`."""

from __future__ import annotations

import sys
import time
from pathlib import Path
from tempfile import TemporaryDirectory

import click

from rmw_manycore_py.cli.common.duration import duration_option
from rmw_manycore_py.cli.common.mapfile_argument import mapfile_argument
from rmw_manycore_py.cli.common.options import examples
from rmw_manycore_py.cli.common.printed_run import print_run
from rmw_manycore_py.cli.common.printing import print_notices
from rmw_manycore_py.cli.common.run_printer import RunPrinter
from rmw_manycore_py.cli.common.starting import prepared_run
from rmw_manycore_py.cli.profile.output import output_option, write
from rmw_manycore_py.errors import ManycoreError
from rmw_manycore_py.launch.events import Event, Notice
from rmw_manycore_py.profile.recorded import profile_of
from rmw_manycore_py.trace.atomic_file import require_writable
from rmw_manycore_py.trace.files import load


@click.command(
    "record",
    epilog=examples(
        "manycore profile record talker_listener --duration 30",
        "manycore profile record image_pipeline --duration 60 -o images.profile.json",
    ),
)
@mapfile_argument()
@duration_option(60.0, "Record this many seconds from the start of the last node.")
@output_option
def command(mapfile: Path, duration_s: float, output: Path) -> None:
    """Run the nodes of MAPFILE and make their profile.

    They are traced as with manycore run --trace; what they do while nodes start is left out.
    """
    require_writable(output)
    started_ns: list[int] = []
    run, _ = prepared_run(mapfile, False, ())
    printer = RunPrinter(run.program_names)
    with TemporaryDirectory(prefix="manycore_") as directory:
        path = Path(directory) / "trace.csv"

        def report(event: Event) -> None:
            if not (isinstance(event, Notice) and str(path) in event.text):  # gone when it is read
                printer.report(event)

        status = print_run(
            run,
            report,
            duration_s,
            lambda: started_ns.append(time.monotonic_ns()),
            path,
        )
        if not started_ns:
            raise ManycoreError("the run ended before all nodes had started: nothing was recorded")
        ended_ns = time.monotonic_ns()
        trace = load(path)
    last_ns = round(min(ended_ns, started_ns[0] + duration_s * 1e9))
    profile = profile_of(trace, started_ns[0], last_ns)
    if trace.lost:
        print_notices([f"{trace.lost} events were lost because rings were full: record less"])
    write(profile, output)
    sys.exit(status)
