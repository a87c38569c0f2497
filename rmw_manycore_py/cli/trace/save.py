# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""`manycore trace save`."""

from __future__ import annotations

from pathlib import Path

import click

from rmw_manycore_py.cli.common.options import examples, platform_option
from rmw_manycore_py.cli.common.output_file import OutputFile
from rmw_manycore_py.cli.common.printing import counted, echo, print_notices
from rmw_manycore_py.cli.common.view import require_platform
from rmw_manycore_py.trace.files.saving import save_recorded
from rmw_manycore_py.trace.formats import SUFFIXES, require_format


@click.command(
    "save",
    epilog=examples("manycore trace save -o trace.json", "manycore trace save -o trace.pftrace"),
)
@click.option(
    "-o",
    "--output",
    required=True,
    type=OutputFile(*SUFFIXES),
    help="Chrome's .json, a .csv of all events, or Perfetto's .pftrace.",
)
@platform_option
def command(output: Path, platform: str) -> None:
    """Write the recorded events to a file.

    Their buffers are freed.
    """
    require_format(output)
    require_platform(platform)
    trace = save_recorded(platform, output)
    if trace.lost:
        print_notices(
            [f"{trace.lost} events were lost because rings were full: use trace start --events N"]
        )
    echo(f"{output}: {counted(trace.event_count, 'event')}")
