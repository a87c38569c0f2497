# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""`manycore topic bw`, printed as `ros2 topic bw` prints."""

from __future__ import annotations

import json
import time
from dataclasses import asdict

import click

from rmw_manycore_py.cli.bandwidth import BandwidthMeter
from rmw_manycore_py.cli.listening import Listener
from rmw_manycore_py.cli.options import examples, platform_option

PERIOD_S = 1.0


@click.command("bw", epilog=examples("manycore topic bw /image"))
@click.argument("topic")
@click.argument("type_name", metavar="[TYPE]", required=False)
@click.option(
    "-w",
    "--window",
    type=click.IntRange(2),
    default=100,
    show_default=True,
    help="Number of messages to look back on.",
)
@click.option("--json", "as_json", is_flag=True, help="Print each result as a line of JSON.")
@platform_option
def command(topic: str, type_name: str | None, platform: str, window: int, as_json: bool) -> None:
    """Print the bandwidth of TOPIC once per second; messages are not deserialized.

    TYPE is needed only while nobody uses the topic.
    """
    meter = BandwidthMeter(window)

    def show() -> None:
        bandwidth = meter.bandwidth(time.monotonic())
        if bandwidth is not None:
            click.echo(json.dumps(asdict(bandwidth)) if as_json else bandwidth)

    listener = Listener(
        platform,
        topic,
        type_name,
        lambda data: meter.arrived(time.monotonic(), len(data)),
        raw=True,
    )
    listener.every(PERIOD_S, show)
    listener.run()
