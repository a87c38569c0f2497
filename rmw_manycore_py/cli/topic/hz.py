# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""`manycore topic hz`, with the output format of `ros2 topic hz`."""

from __future__ import annotations

import time
from typing import Any

import click

from rmw_manycore_py.cli.common.options import examples
from rmw_manycore_py.cli.topic.listening import Listener
from rmw_manycore_py.cli.topic.measuring import PERIOD_S, measuring_options, print_result
from rmw_manycore_py.cli.topic.message_part import message_filter
from rmw_manycore_py.cli.topic.meters.rate import Rate, RateMeter


@click.command("hz", epilog=examples("manycore topic hz /chatter"))
@measuring_options(1, 10000, "intervals")
@click.option(
    "--filter", "expression", metavar="EXPR", help="Count messages m for which EXPR is true."
)
@click.option("--wall-time", is_flag=True, help="Measure with the wall clock, even with -s.")
def command(
    topic: str,
    type_name: str | None,
    platform: str,
    window: int,
    expression: str | None,
    wall_time: bool,
    as_json: bool,
    sim_time: bool,
) -> None:
    """Print the rate of TOPIC once per second.

    Prints nothing while no messages arrive. Messages are deserialized only for --filter.

    Waits until TOPIC exists; with TYPE, subscribes at once.
    """
    meter, fulfils = RateMeter(window), message_filter(expression)
    printed: Rate | None = None

    def show() -> None:
        nonlocal printed
        rate = meter.rate()
        if rate is not None and rate != printed:
            print_result(rate, as_json)
            printed = rate

    def heard(message: Any) -> None:
        now_s = time.time() if wall_time else listener.now_s()
        if now_s and fulfils(message):  # simulated time is zero until the first /clock
            meter.arrived(now_s)

    listener = Listener(
        platform,
        topic,
        type_name,
        heard,
        raw=expression is None,
        sim_time=sim_time,
        waits=True,
    )
    listener.every(PERIOD_S, show)
    listener.run()
