# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""`manycore top`."""

from __future__ import annotations

import json
import sys
import time
from contextlib import ExitStack, suppress

import click
from rich.console import Group
from rich.live import Live
from rich.table import Table

from rmw_manycore_py.cli.common import view
from rmw_manycore_py.cli.common.options import examples, platform_option
from rmw_manycore_py.cli.common.printing import new_table, print_table, size_text
from rmw_manycore_py.cli.common.rows import Row
from rmw_manycore_py.cli.top.load import process_loads, take_sample, topic_loads


@click.command("top", epilog=examples("manycore top", "manycore top --count 1 --json"))
@click.option(
    "--period",
    "period_s",
    type=click.FloatRange(min=0.1),
    default=1.0,
    show_default=True,
    help="Seconds between two looks.",
)
@click.option("--count", type=click.IntRange(1), help="End after that many looks.")
@click.option("--json", "as_json", is_flag=True, help="Print each look as a line of JSON.")
@platform_option
def command(platform: str, period_s: float, count: int | None, as_json: bool) -> None:
    """Show the busiest processes and topics of a platform, until Ctrl-C."""
    with ExitStack() as stack:
        opened = stack.enter_context(view.open_platform(platform))
        before, looks = take_sample(opened), 0
        stack.enter_context(suppress(KeyboardInterrupt))
        live = stack.enter_context(_screen()) if sys.stdout.isatty() and not as_json else None
        while count is None or looks < count:
            time.sleep(period_s)
            after = take_sample(opened)
            processes, topics = process_loads(before, after), topic_loads(before, after)
            if as_json:
                click.echo(json.dumps({"processes": processes, "topics": topics}))
            elif live:
                live.update(Group(_processes(processes), "", _topics(topics)), refresh=True)
            else:
                print_table(_processes(processes))
                print_table(_topics(topics))
            before, looks = after, looks + 1


def _screen() -> Live:
    return Live(auto_refresh=False, screen=True)


def _processes(rows: list[Row]) -> Table:
    table = new_table("#pid", "#cluster", "#core", "#host CPU", "#CPU", "program")
    for row in rows:
        places = (row["cluster"], row["core"], row["host_cpu"])
        texts = ("-" if place is None else str(place) for place in places)
        table.add_row(str(row["pid"]), *texts, f"{row['cpu_percent']:.1f}%", row["label"])
    return table


def _topics(rows: list[Row]) -> Table:
    table = new_table("#messages/s", "#bytes/s", "#lost", "topic")
    for row in rows:
        size = size_text(round(row["bytes_per_s"]))
        table.add_row(f"{row['messages_per_s']:.1f}", size, str(row["lost"]), row["topic"])
    return table
