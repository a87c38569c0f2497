# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""`manycore topic pub`, printed as `ros2 topic pub` prints."""

from __future__ import annotations

import time
from collections.abc import Iterator
from typing import Any

import click
from builtin_interfaces.msg import Time

from rmw_manycore_py.cli.common.interface_types import load_type
from rmw_manycore_py.cli.common.message_values import message_of, parse_values
from rmw_manycore_py.cli.common.options import examples, platform_option, values_argument
from rmw_manycore_py.cli.common.tool_node import spin_once, tool_node
from rmw_manycore_py.cli.topic.qos_options import QosOptions, qos_options
from rmw_manycore_py.errors import ManycoreError

# How long the node stays after its last message, for late ends of its matches to see it.
KEEP_ALIVE_S = 0.1
# How often a waiting publisher says so.
TOLD_PERIOD_S = 1.0


@click.command(
    "pub",
    epilog=examples(
        "manycore topic pub /chatter std_msgs/msg/String 'data: hello'",
        "manycore topic pub --once /chatter std_msgs/msg/String 'data: hello'",
        "manycore topic pub -r 10 /pose geometry_msgs/msg/PoseStamped '{header: auto}'",
    ),
)
@click.argument("topic")
@click.argument("type_name", metavar="TYPE")
@values_argument
@click.option(
    "-r",
    "--rate",
    "rate_hz",
    type=click.FloatRange(min=0, min_open=True),
    default=1.0,
    show_default=True,
    help="Messages per second.",
)
@click.option("-1", "--once", is_flag=True, help="Publish one message and end.")
@click.option("-t", "--times", type=click.IntRange(0), default=0, help="Publish that many and end.")
@click.option(
    "-p",
    "--print",
    "shown",
    metavar="N",
    type=click.IntRange(0),
    default=1,
    show_default=True,
    help="Print every N-th message.",
)
@click.option(
    "-w",
    "--wait-matching-subscriptions",
    "wanted",
    type=click.IntRange(0),
    help="Begin when that many subscriptions match; by default 1 with --once and --times, else 0.",
)
@click.option(
    "--max-wait-time-secs",
    "patience_s",
    metavar="S",
    type=click.FloatRange(min=0, min_open=True),
    help="Give up when they do not match within S seconds.",
)
@click.option(
    "--keep-alive",
    "keep_alive_s",
    metavar="S",
    type=click.FloatRange(min=0),
    default=KEEP_ALIVE_S,
    show_default=True,
    help="Stay S seconds after the last message.",
)
@click.option("-n", "--node-name", metavar="NAME", help="Name of the publishing node.")
@qos_options
@platform_option
def command(
    topic: str,
    type_name: str,
    values: str,
    rate_hz: float,
    once: bool,
    times: int,
    shown: int,
    wanted: int | None,
    patience_s: float | None,
    keep_alive_s: float,
    node_name: str | None,
    qos: QosOptions,
    platform: str,
) -> None:
    """Publish messages of TYPE on TOPIC, with VALUES in YAML and defaults elsewhere.

    The word `auto` stands for a header, and `now` for a time, of the moment of publishing.
    """
    message_type, fields = load_type(type_name), parse_values(values)
    message_of(message_type, fields, Time())
    times = 1 if once else times
    with tool_node(platform, node_name) as node:
        publisher = node.create_publisher(message_type, topic, qos.profile())
        wanted = int(times > 0) if wanted is None else wanted
        _wait_for_subscriptions(node, publisher, wanted, patience_s)
        click.echo("publisher: beginning loop")
        for number in _ticks(node, 1 / rate_hz, times):
            message = message_of(message_type, fields, node.get_clock().now().to_msg())
            if shown and number % shown == 0:
                click.echo(f"publishing #{number}: {message!r}\n")
            publisher.publish(message)
        time.sleep(keep_alive_s)


def _wait_for_subscriptions(
    node: Any, publisher: Any, wanted: int, patience_s: float | None
) -> None:
    start_s = time.monotonic()
    told = 0  # once per second
    while (found := publisher.get_subscription_count()) < wanted:
        waited_s = time.monotonic() - start_s
        if told and patience_s is not None and waited_s >= patience_s:
            raise ManycoreError(
                f"timed out waiting for subscriptions: {wanted} wanted, {found} matched"
            )
        if waited_s >= told * TOLD_PERIOD_S:
            click.echo(f"Waiting for at least {wanted} matching subscription(s)...")
            told += 1
        spin_once(node)


def _ticks(node: Any, period_s: float, times: int) -> Iterator[int]:
    """Yield 1, 2, ... once per period, as often as asked for or, if that is 0, for ever."""
    number, due_s = 0, time.monotonic()
    while not times or number < times:
        while (left_s := due_s - time.monotonic()) > 0:
            spin_once(node, left_s)
        number += 1
        due_s += period_s
        yield number
