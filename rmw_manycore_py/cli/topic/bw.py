# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""`manycore topic bw`, with the output format of `ros2 topic bw`."""

from __future__ import annotations

import click

from rmw_manycore_py.cli.common.options import examples
from rmw_manycore_py.cli.common.printing import echo
from rmw_manycore_py.cli.topic.listening import Listener
from rmw_manycore_py.cli.topic.measuring import PERIOD_S, measuring_options, print_result
from rmw_manycore_py.cli.topic.meters.bandwidth import BandwidthMeter


@click.command("bw", epilog=examples("manycore topic bw /image"))
@measuring_options(2, 100, "messages")
def command(
    topic: str,
    type_name: str | None,
    platform: str,
    window: int,
    as_json: bool,
    sim_time: bool,
) -> None:
    """Print the bandwidth of TOPIC once per second.

    Messages are not deserialized. Waits until TOPIC exists; with TYPE, subscribes at once.
    """
    meter = BandwidthMeter(window)

    def show() -> None:
        bandwidth = meter.bandwidth(listener.now_s())
        if bandwidth is not None:
            print_result(bandwidth, as_json)

    listener = Listener(
        platform,
        topic,
        type_name,
        lambda data: meter.arrived(listener.now_s(), len(data)),
        raw=True,
        sim_time=sim_time,
        waits=True,
        subscribed=None if as_json else lambda name: echo(f"Subscribed to [{name}]"),
    )
    listener.every(PERIOD_S, show)
    listener.run()
