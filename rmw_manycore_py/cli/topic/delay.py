# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""`manycore topic delay`, printed as `ros2 topic delay` prints."""

from __future__ import annotations

import time
from typing import Any

import click

from rmw_manycore_py.cli.common.options import examples
from rmw_manycore_py.cli.topic.listening import Listener
from rmw_manycore_py.cli.topic.measuring import PERIOD_S, measuring_options, print_result
from rmw_manycore_py.cli.topic.meters.delay import Delay, DelayMeter
from rmw_manycore_py.errors import ManycoreError


@click.command("delay", epilog=examples("manycore topic delay /points"))
@measuring_options(1, 10000, "messages")
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
            print_result(delay, as_json)
            printed = delay

    listener = Listener(platform, topic, type_name, heard)
    listener.every(PERIOD_S, show)
    listener.run()
