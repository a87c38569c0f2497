# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""`manycore topic hz`, printed as `ros2 topic hz` prints."""

from __future__ import annotations

import json
import time
from dataclasses import asdict

import click

from rmw_manycore_py.cli.listening import Listener
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
@click.option("--json", "as_json", is_flag=True, help="Print each result as a line of JSON.")
@platform_option
def command(topic: str, type_name: str | None, platform: str, window: int, as_json: bool) -> None:
    """Print the rate of TOPIC once per second while messages come; they are not deserialized.

    TYPE is needed only while nobody uses the topic.
    """
    meter = RateMeter(window)
    printed: Rate | None = None

    def show() -> None:
        nonlocal printed
        rate = meter.rate()
        if rate is not None and rate != printed:
            click.echo(json.dumps(asdict(rate)) if as_json else rate)
            printed = rate

    listener = Listener(
        platform, topic, type_name, lambda _: meter.arrived(time.monotonic()), raw=True
    )
    listener.every(PERIOD_S, show)
    listener.run()
