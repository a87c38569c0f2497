# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""`manycore topic list`, with the output format of `ros2 topic list`."""

from __future__ import annotations

from collections.abc import Iterable

import click

from rmw_manycore_py.cli.common import view
from rmw_manycore_py.cli.common.names import show_names
from rmw_manycore_py.cli.common.options import examples, listing_options, types_option
from rmw_manycore_py.cli.common.printing import counted, echo, escaped
from rmw_manycore_py.cli.common.rows import Row


@click.command("list", epilog=examples("manycore topic list -t", "manycore topic list --json"))
@types_option
@click.option("-v", "--verbose", is_flag=True, help="Show publishers and subscriptions.")
@listing_options
def command(
    platform: str, as_json: bool, show_types: bool, verbose: bool, count: bool, hidden: bool
) -> None:
    """List the topics of a platform."""
    rows = view.topics(view.endpoints_on(platform), hidden=hidden)
    if verbose and rows and not as_json and not count:
        _show_users(rows, "Published topics", "publisher")
        _show_users(rows, "Subscribed topics", "subscription")
        return
    show_names(rows, as_json=as_json, types=show_types, count=count)


def _show_users(rows: Iterable[Row], title: str, kind: str) -> None:
    echo(f"{title}:")
    for row in rows:
        number, noun = row[f"{kind}s"], "subscriber" if kind == "subscription" else kind
        if number:
            types = ", ".join(row["types"])
            echo(f" * {escaped(row['name'])} [{escaped(types)}] {counted(number, noun)}")
    echo()
