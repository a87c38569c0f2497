# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""`manycore topic hz`, printed as `ros2 topic hz` prints."""

from __future__ import annotations

import json
import time
from dataclasses import asdict
from typing import Any

import click

from rmw_manycore_py.cli.listening import Listener
from rmw_manycore_py.cli.message_part import message_filter
from rmw_manycore_py.cli.options import examples, platform_option
from rmw_manycore_py.cli.rate import Rate, RateMeter

PERIOD_S = 1.0


@click.command("hz", epilog=examples("manycore topic hz /chatter"))
@click.argument("topic")
@click.argument("type_name", metavar="[TYPE]", required=False)
@click.option(
    "-w",
    "--window",
    type=click.IntRange(1),
    default=10000,
    show_default=True,
    help="Number of intervals to look back on.",
)
@click.option("--filter", "expression", metavar="EXPR", help="Count what it holds for, as m.")
@click.option("--wall-time", is_flag=True, help="Accepted as of ros2: no other time is used.")
@click.option("--json", "as_json", is_flag=True, help="Print each result as a line of JSON.")
@platform_option
def command(
    topic: str,
    type_name: str | None,
    platform: str,
    window: int,
    expression: str | None,
    wall_time: bool,  # noqa: ARG001
    as_json: bool,
) -> None:
    """Print the rate of TOPIC once per second while messages come.

    They are not deserialized, unless there is a filter.

    TYPE is needed only while nobody uses the topic.
    """
    meter, fulfils = RateMeter(window), message_filter(expression)
    printed: Rate | None = None

    def show() -> None:
        nonlocal printed
        rate = meter.rate()
        if rate is not None and rate != printed:
            click.echo(json.dumps(asdict(rate)) if as_json else rate)
            printed = rate

    def heard(message: Any) -> None:
        if fulfils(message):
            meter.arrived(time.monotonic())

    listener = Listener(platform, topic, type_name, heard, raw=expression is None)
    listener.every(PERIOD_S, show)
    listener.run()
