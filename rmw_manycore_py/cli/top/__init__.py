# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""`manycore top`."""

from __future__ import annotations

import json
import os
import signal
import sys
import time
from collections.abc import Callable, Iterator
from contextlib import closing, suppress
from functools import partial

import click
from rich.console import Console

from rmw_manycore_py.cli.common.finite_range import WholeRange
from rmw_manycore_py.cli.common.keyboard import single_keys
from rmw_manycore_py.cli.common.looking import look_at
from rmw_manycore_py.cli.common.options import examples, number_option, platform_option
from rmw_manycore_py.cli.common.view import require_platform
from rmw_manycore_py.cli.top.interaction import Interaction
from rmw_manycore_py.cli.top.rows import (
    NODE_ORDERS,
    TOPIC_ORDERS,
    cluster_rows,
    node_rows,
    process_rows,
    topic_rows,
)
from rmw_manycore_py.cli.top.screen import Choices, screen
from rmw_manycore_py.platform.monitor.watch import Look, Watch

_PLAIN_WIDTH = 1000  # no line breaks in pipes and files


@click.command(
    "top",
    epilog=examples(
        "manycore top",
        "manycore top --topics lost --filter /lidar",
        "manycore top --count 1 --json",
    ),
)
@number_option(
    "--period", "period_s", within=(0.1, None), default=1.0, help="Seconds between updates."
)
@click.option("--count", type=WholeRange(1), metavar="N", help="Exit after N updates.")
@click.option("--json", "as_json", is_flag=True, help="Print one JSON object per update.")
@click.option(
    "--nodes",
    "node_order",
    type=click.Choice(list(NODE_ORDERS)),
    default="cpu",
    show_default=True,
    help="Sort order of the nodes.",
)
@click.option(
    "--topics",
    "topic_order",
    type=click.Choice(list(TOPIC_ORDERS)),
    default="bytes",
    show_default=True,
    help="Sort order of the topics.",
)
@click.option(
    "--filter", "pattern", default="", help="Only nodes and topics whose name contains this."
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
    """Show nodes, topics and memory, until q or Ctrl-C.

    Keys: n and t change the order of nodes and topics, r reverses it, / filters, q quits.
    """
    require_platform(platform)
    choices = Choices(node_order, topic_order, pattern=pattern)
    with closing(Watch(platform, window_s=period_s)) as watch, suppress(KeyboardInterrupt):
        look_now = partial(look_at, platform, watch)
        if not as_json and _interact(look_now, period_s, count, choices):
            return
        for look in _looks(look_now, period_s, count):
            if as_json:
                click.echo(json.dumps(_row(look)))
            else:
                _print(look, choices)


def _looks(look_now: Callable[[], Look], period_s: float, count: int | None) -> Iterator[Look]:
    """Yield one look per period; the first after one period."""
    look_now()
    done = 0
    while count is None or done < count:
        time.sleep(period_s)
        yield look_now()
        done += 1


def _interact(
    look_now: Callable[[], Look], period_s: float, count: int | None, choices: Choices
) -> bool:
    """Run on the terminal; return whether there is a usable one."""
    interaction = Interaction(look_now, period_s, count, choices)
    while True:
        with single_keys(wanted=_is_screen()) as keyboard:
            is_stopped = keyboard is not None and interaction.run(keyboard)
        if not is_stopped:
            return keyboard is not None
        os.kill(os.getpid(), signal.SIGSTOP)  # until the shell continues it with fg or bg


def _is_screen() -> bool:
    """Return whether the terminal can be redrawn; a dumb one is printed to."""
    return sys.stdout.isatty() and not Console().is_dumb_terminal


def _row(look: Look) -> dict[str, object]:
    return {
        "virtual_s": look.virtual_s,
        "clusters": cluster_rows(look),
        "nodes": node_rows(look),
        "processes": process_rows(look),
        "topics": topic_rows(look),
    }


def _print(look: Look, choices: Choices) -> None:
    console = Console(width=None if sys.stdout.isatty() else _PLAIN_WIDTH)
    with console.capture() as capture:
        console.print(screen(look, choices))
    lines = (line.rstrip() for line in capture.get().splitlines())
    click.echo("\n".join(line for line in lines if line))
