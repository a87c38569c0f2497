# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""`manycore trace compare`."""

from __future__ import annotations

from pathlib import Path

import click

from rmw_manycore_py.cli.common.options import examples, json_option
from rmw_manycore_py.cli.common.printing import new_table, print_json, print_table
from rmw_manycore_py.cli.trace.latency import evaluated
from rmw_manycore_py.errors import ManycoreError
from rmw_manycore_py.trace.comparison import compare
from rmw_manycore_py.trace.files import load

_FILE = click.Path(dir_okay=False, path_type=Path)


@click.command("compare", epilog=examples("manycore trace compare before.json after.json"))
@click.argument("before", type=_FILE)
@click.argument("after", type=_FILE)
@json_option
def command(before: Path, after: Path, as_json: bool) -> None:
    """Compare the traces BEFORE and AFTER.

    Medians in microseconds. A part has changed if the 95 % confidence intervals of its medians
    do not overlap.
    """
    changes = compare(evaluated(load(before)), evaluated(load(after)))
    if not changes:
        raise ManycoreError(f"{before} and {after} have no chain in common")
    if as_json:
        print_json([change.row() for change in changes])
        return
    table = new_table("chain", "part", "#before", "#after", "verdict")
    for change in changes:
        medians = (f"{change.before_us:.1f}", f"{change.after_us:.1f}")
        table.add_row(change.chain, change.part, *medians, change.verdict)
    print_table(table)
