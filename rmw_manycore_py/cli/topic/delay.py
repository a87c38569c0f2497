# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""`manycore topic delay`, with the output format of `ros2 topic delay`."""

from __future__ import annotations

from typing import Any

import click

from rmw_manycore_py.cli.common.options import examples
from rmw_manycore_py.cli.common.printing import echo
from rmw_manycore_py.cli.topic.listening import Listener
from rmw_manycore_py.cli.topic.measuring import PERIOD_S, measuring_options, print_result
from rmw_manycore_py.cli.topic.meters.delay import Delay, DelayMeter
from rmw_manycore_py.errors import ManycoreError


@click.command("delay", epilog=examples("manycore topic delay /points"))
@measuring_options(1, 10000, "messages")
def command(
    topic: str,
    type_name: str | None,
    platform: str,
    window: int,
    as_json: bool,
    sim_time: bool,
) -> None:
    """Print the age of messages on TOPIC.

    By their header stamp, once per second. Waits until TOPIC exists; with TYPE, subscribes at
    once.
    """
    meter = DelayMeter(window)
    printed: Delay | None = None

    def heard(message: Any) -> None:
        if not hasattr(message, "header"):
            raise ManycoreError(f"msg does not have header: messages of '{topic}' have no stamp")
        stamp, now_s = message.header.stamp, listener.now_s()
        if now_s:  # simulated time is zero until the first /clock
            meter.arrived(now_s - stamp.sec - stamp.nanosec * 1e-9)

    def show() -> None:
        nonlocal printed
        delay = meter.delay()
        if delay is not None and delay != printed:
            print_result(delay, as_json)
            printed = delay
        elif delay is not None and not as_json:
            echo("no new messages")

    listener = Listener(platform, topic, type_name, heard, sim_time=sim_time, waits=True)
    listener.every(PERIOD_S, show)
    listener.run()
