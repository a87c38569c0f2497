# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""`manycore top`."""

from __future__ import annotations

import json
import sys
import time
from collections.abc import Iterator
from contextlib import closing, suppress

import click
from rich.console import Console
from rich.live import Live

from rmw_manycore_py.cli.common.options import examples, platform_option
from rmw_manycore_py.cli.common.view import require_platform
from rmw_manycore_py.cli.top.keys import after_keys, key_by_key, pressed
from rmw_manycore_py.cli.top.rows import (
    NODE_ORDERS,
    TOPIC_ORDERS,
    cluster_rows,
    node_rows,
    process_rows,
    topic_rows,
)
from rmw_manycore_py.cli.top.screen import Choices, screen
from rmw_manycore_py.errors import ManycoreError
from rmw_manycore_py.look.watch import Look, Watch
from rmw_manycore_py.native_errors import translate_native_errors

_PLAIN_WIDTH = 1000  # into a pipe or a file: no line is broken


@click.command(
    "top",
    epilog=examples(
        "manycore top",
        "manycore top --topics lost --filter /lidar",
        "manycore top --count 1 --json",
    ),
)
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
@click.option(
    "--nodes",
    "node_order",
    type=click.Choice(list(NODE_ORDERS)),
    default="cpu",
    show_default=True,
    help="Order of the nodes.",
)
@click.option(
    "--topics",
    "topic_order",
    type=click.Choice(list(TOPIC_ORDERS)),
    default="bytes",
    show_default=True,
    help="Order of the topics.",
)
@click.option(
    "--filter", "pattern", default="", help="Only nodes and topics with this in their name."
)
@platform_option
def command(
    platform: str,
    period_s: float,
    count: int | None,
    as_json: bool,
    node_order: str,
    topic_order: str,
    pattern: str,
) -> None:
    """Show nodes, topics and memory of a platform, until q or Ctrl-C.

    Keys: n and t change the order of nodes and topics, r reverses it, / filters, q quits.
    """
    require_platform(platform)
    choices = Choices(node_order, topic_order, pattern=pattern)
    with closing(Watch(platform, window_s=period_s)) as watch, suppress(KeyboardInterrupt):
        if as_json:
            for look in _looks(watch, platform, period_s, count):
                click.echo(json.dumps(_row(look)))
        elif sys.stdout.isatty() and sys.stdin.isatty():
            _interact(watch, platform, period_s, count, choices)
        else:
            for look in _looks(watch, platform, period_s, count):
                _print(look, choices)


def _looks(watch: Watch, platform: str, period_s: float, count: int | None) -> Iterator[Look]:
    """Yield a look per period, the first one after one period."""
    _look(watch, platform)
    done = 0
    while count is None or done < count:
        time.sleep(period_s)
        yield _look(watch, platform)
        done += 1


def _look(watch: Watch, platform: str) -> Look:
    with translate_native_errors():
        look = watch.look()
    if look is None:
        raise ManycoreError(f"platform {platform} has ended")
    return look


def _row(look: Look) -> dict[str, object]:
    return {
        "clusters": cluster_rows(look),
        "nodes": node_rows(look),
        "processes": process_rows(look),
        "topics": topic_rows(look),
    }


def _print(look: Look, choices: Choices) -> None:
    console = Console(width=_PLAIN_WIDTH)
    with console.capture() as capture:
        console.print(screen(look, choices))
    lines = (line.rstrip() for line in capture.get().splitlines())
    click.echo("\n".join(line for line in lines if line))


def _interact(
    watch: Watch, platform: str, period_s: float, count: int | None, choices: Choices
) -> None:
    look = _look(watch, platform)
    due_s, done = time.monotonic() + min(period_s, 0.3), 0  # the first figures soon
    with key_by_key(), Live(auto_refresh=False, screen=True) as live:
        while count is None or done < count:
            live.update(screen(look, choices, live.console.height), refresh=True)
            after = after_keys(choices, pressed(due_s - time.monotonic()))
            if after is None:
                return
            choices = after
            if time.monotonic() >= due_s:
                look, due_s, done = _look(watch, platform), time.monotonic() + period_s, done + 1
