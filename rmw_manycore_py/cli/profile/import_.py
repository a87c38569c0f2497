# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""`manycore profile import`."""

from __future__ import annotations

from pathlib import Path

import click

from rmw_manycore_py.cli.common.finite_range import FiniteRange
from rmw_manycore_py.cli.common.options import examples
from rmw_manycore_py.cli.profile.output import output_option, write
from rmw_manycore_py.profile.importing import import_source
from rmw_manycore_py.profile.ros2_tracing import Window


@click.command(
    "import",
    epilog=examples(
        "manycore profile import ~/.ros/tracing/session -o app.profile.json",
        "manycore profile import trace --end 30 -o first_half.profile.json",
        "manycore profile import caret_report -o autoware.profile.json",
    ),
)
@click.argument("source", type=click.Path(exists=True, file_okay=False, path_type=Path))
@output_option
@click.option(
    "--begin",
    "begin_s",
    type=FiniteRange(min=0),
    default=0.0,
    metavar="S",
    help="Skip callbacks of the first S seconds of a trace.",
)
@click.option(
    "--end",
    "end_s",
    type=FiniteRange(min=0, min_open=True),
    metavar="S",
    help="Skip callbacks after the first S seconds of a trace.",
)
def command(source: Path, output: Path, begin_s: float, end_s: float | None) -> None:
    """Make a profile from other tools' measurements.

    SOURCE is a directory: an LTTng trace of ros2_tracing or CARET, or a report of CARET with
    architecture*.yaml and stats_node.yaml.
    """
    if end_s is not None and begin_s >= end_s:
        raise click.UsageError(f"expected --begin before --end, found {begin_s:g} and {end_s:g}")
    end_ns = None if end_s is None else round(end_s * 1e9)
    profile = import_source(source, Window(round(begin_s * 1e9), end_ns))
    write(profile, output)
