# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""`manycore topic delay`, printed as `ros2 topic delay` prints."""

from __future__ import annotations

import json
import time
from dataclasses import asdict
from typing import Any

import click

from rmw_manycore_py.cli.delay import Delay, DelayMeter
from rmw_manycore_py.cli.listening import Listener
from rmw_manycore_py.cli.options import examples, platform_option
from rmw_manycore_py.errors import ManycoreError

PERIOD_S = 1.0


@click.command("delay", epilog=examples("manycore topic delay /points"))
@click.argument("topic")
@click.argument("type_name", metavar="[TYPE]", required=False)
@click.option(
    "-w",
    "--window",
    type=click.IntRange(1),
    default=10000,
    show_default=True,
    help="Number of messages to look back on.",
)
@click.option("--json", "as_json", is_flag=True, help="Print each result as a line of JSON.")
@platform_option
def command(topic: str, type_name: str | None, platform: str, window: int, as_json: bool) -> None:
    """Print how old the messages of TOPIC are by the stamp in their header, once per second.

    TYPE is needed only while nobody uses the topic.
    """
    meter = DelayMeter(window)
    printed: Delay | None = None

    def heard(message: Any) -> None:
        if not hasattr(message, "header"):
            raise ManycoreError(f"messages of '{topic}' have no header with a stamp")
        stamp = message.header.stamp
        meter.arrived(time.time() - stamp.sec - stamp.nanosec * 1e-9)

    def show() -> None:
        nonlocal printed
        delay = meter.delay()
        if delay is not None and delay != printed:
            click.echo(json.dumps(asdict(delay)) if as_json else delay)
            printed = delay

    listener = Listener(platform, topic, type_name, heard)
    listener.every(PERIOD_S, show)
    listener.run()
