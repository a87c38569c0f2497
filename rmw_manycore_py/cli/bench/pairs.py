# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""`manycore bench pairs`."""

from __future__ import annotations

import statistics
from pathlib import Path

import click
from rich.console import Console

from rmw_manycore_py.bench.pairs import MIN_PAIRS, compare
from rmw_manycore_py.bench.question import PAYLOADS
from rmw_manycore_py.bench.session import usable_cpus
from rmw_manycore_py.cli.common.options import examples, json_option, number_option
from rmw_manycore_py.cli.common.printing import echo, print_json


@click.command(
    "pairs",
    epilog=examples(
        "manycore bench pairs build/without_trace/lib",
        "manycore bench pairs --size '1 MiB' --between build/before/lib",
    ),
)
@click.argument("other", type=click.Path(file_okay=False, path_type=Path))
@number_option("--pairs", within=(MIN_PAIRS, None), default=30, help="Pairs of runs.")
@click.option(
    "--size",
    default="64 B",
    show_default=True,
    type=click.Choice(list(PAYLOADS)),
    help="Size of a message.",
)
@click.option("--between", is_flag=True, help="Between two clusters instead of inside of one.")
@json_option
def command(other: Path, pairs: int, size: str, between: bool, as_json: bool) -> None:
    """Compare round trips with those of another build.

    In alternating pairs of runs. OTHER is the directory with the librmw_manycore.so of the
    other build.
    """
    with Console(stderr=True).status("bench") as status:
        found = compare(other, pairs, usable_cpus(), status.update, size=size, between=between)
    if as_json:
        print_json(found.row())
        return
    place = "between clusters" if between else "inside a cluster"
    low_us, high_us = found.interval_us()
    echo(f"round trip {size} {place}, {pairs} pairs, medians of runs:")
    echo(f"  this build   {statistics.median(found.this_us):8.3f} us")
    echo(f"  other build  {statistics.median(found.other_us):8.3f} us")
    echo(
        f"  difference   {statistics.median(found.differences_us):+8.3f} us "
        f"(95 % confidence: {low_us:+.3f} to {high_us:+.3f})"
    )
