# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""`manycore topic bw`, printed as `ros2 topic bw` prints."""

from __future__ import annotations

import time

import click

from rmw_manycore_py.cli.common.options import examples
from rmw_manycore_py.cli.topic.listening import Listener
from rmw_manycore_py.cli.topic.measuring import PERIOD_S, measuring_options, print_result
from rmw_manycore_py.cli.topic.meters.bandwidth import BandwidthMeter


@click.command("bw", epilog=examples("manycore topic bw /image"))
@measuring_options(2, 100, "messages")
def command(topic: str, type_name: str | None, platform: str, window: int, as_json: bool) -> None:
    """Print the bandwidth of TOPIC once per second; messages are not deserialized.

    TYPE is needed only while nobody uses the topic.
    """
    meter = BandwidthMeter(window)

    def show() -> None:
        bandwidth = meter.bandwidth(time.monotonic())
        if bandwidth is not None:
            print_result(bandwidth, as_json)

    listener = Listener(
        platform,
        topic,
        type_name,
        lambda data: meter.arrived(time.monotonic(), len(data)),
        raw=True,
    )
    listener.every(PERIOD_S, show)
    listener.run()
