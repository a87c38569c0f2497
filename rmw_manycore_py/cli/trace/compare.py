# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""`manycore trace compare`."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path

import click

from rmw_manycore_py.cli.common.options import examples, json_option
from rmw_manycore_py.cli.common.printing import echo, new_table, print_json, print_table
from rmw_manycore_py.cli.common.rates import load_rates
from rmw_manycore_py.cli.trace.latency import evaluated
from rmw_manycore_py.errors import ManycoreError
from rmw_manycore_py.mapfile.mapping.compared import ClusterTraffic, row, verdict
from rmw_manycore_py.mapfile.mapping.verdict import rates_text
from rmw_manycore_py.trace.comparison import Change, compare
from rmw_manycore_py.trace.latency import TOTAL

_FILE = click.Path(dir_okay=False, path_type=Path)


@click.command(
    "compare",
    epilog=examples(
        "manycore trace compare before.json after.json",
        "manycore trace compare --parts before.json after.json",
    ),
)
@click.argument("before", type=_FILE)
@click.argument("after", type=_FILE)
@click.option("--parts", is_flag=True, help="Also show the parts of each chain.")
@json_option
def command(before: Path, after: Path, parts: bool, as_json: bool) -> None:
    """Compare the traces BEFORE and AFTER.

    A line for each chain has the medians of its latency, which has changed if their 95 %
    confidence intervals do not overlap. The last line is about the mapping: messages and bytes
    between clusters.
    """
    traces = load_rates(before), load_rates(after)
    changes = compare(*map(evaluated, traces))
    if not changes:
        raise ManycoreError(f"{before} and {after} have no chain in common")
    traffic = [ClusterTraffic.of(trace) for trace in traces]
    if as_json:
        print_json([*(change.row() for change in changes), row(*traffic)])
        return
    table = new_table("#before", "#after", "verdict", "chain")
    for change in changes:
        if change.part == TOTAL:
            table.add_row(*_medians(change), change.verdict, change.chain)
    print_table(table)
    old, new = map(_words, traffic)
    echo(f"between clusters: {old} before, {new} after: {verdict(*traffic)}")
    if parts:
        _show_parts(changes)


def _words(traffic: ClusterTraffic) -> str:
    rates = rates_text(traffic.messages_per_s, traffic.bytes_per_s)
    return f"{rates} ({traffic.share:.0%} of all messages)"


def _show_parts(changes: Sequence[Change]) -> None:
    echo()
    table = new_table("chain", "part", "#before", "#after", "verdict")
    for change in changes:
        table.add_row(change.chain, change.part, *_medians(change), change.verdict)
    print_table(table)


def _medians(change: Change) -> tuple[str, str]:
    return f"{change.before_us:.1f} us", f"{change.after_us:.1f} us"
