# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""`manycore bench pairs`."""

from __future__ import annotations

import statistics
from pathlib import Path

import click
from rich.console import Console

from rmw_manycore_py.bench.pairs import MIN_PAIRS, SIZE, compare
from rmw_manycore_py.bench.session import usable_cpus
from rmw_manycore_py.cli.common.options import examples, json_option
from rmw_manycore_py.cli.common.printing import print_json


@click.command("pairs", epilog=examples("manycore bench pairs build/without_trace/lib"))
@click.argument("other", type=click.Path(file_okay=False, path_type=Path))
@click.option("--pairs", default=30, show_default=True, type=click.IntRange(MIN_PAIRS))
@json_option
def command(other: Path, pairs: int, as_json: bool) -> None:
    """Compare round trips of 64 B with those of another build, in alternated pairs of runs.

    OTHER is the directory of the other build's librmw_manycore.so.
    """
    with Console(stderr=True).status("bench") as status:
        found = compare(other, pairs, usable_cpus(), status.update)
    if as_json:
        print_json(found.row())
        return
    low_us, high_us = found.interval_us()
    click.echo(f"round trip {SIZE}, {pairs} pairs, medians of runs:")
    click.echo(f"  this build   {statistics.median(found.this_us):8.3f} us")
    click.echo(f"  other build  {statistics.median(found.other_us):8.3f} us")
    click.echo(
        f"  difference   {statistics.median(found.differences_us):+8.3f} us "
        f"(95 % confidence: {low_us:+.3f} to {high_us:+.3f})"
    )
