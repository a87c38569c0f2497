# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""`manycore topic pub`, with the output format of `ros2 topic pub`."""

from __future__ import annotations

import time
from collections.abc import Iterator
from itertools import repeat
from pathlib import Path
from typing import Any

import click
from builtin_interfaces.msg import Time

from rmw_manycore_py.cli.common.completion import complete_topics, complete_types_of_topic
from rmw_manycore_py.cli.common.finite_range import MIN_RATE, FiniteRange, WholeRange
from rmw_manycore_py.cli.common.interface_types import load_type
from rmw_manycore_py.cli.common.message_values import message_of, parse_values, read_values
from rmw_manycore_py.cli.common.options import (
    examples,
    number_option,
    platform_option,
    talking_options,
)
from rmw_manycore_py.cli.common.printing import echo
from rmw_manycore_py.cli.common.seconds import Seconds
from rmw_manycore_py.cli.common.tool_node import tool_node
from rmw_manycore_py.cli.common.values_argument import DEFAULTS, exclude, values_argument
from rmw_manycore_py.cli.topic.qos_options import QosOptions, qos_options
from rmw_manycore_py.cli.topic.subscribers import wait_for_subscriptions
from rmw_manycore_py.process.spinning import spin_once

# Lifetime of the node after its last message, so that slow subscribers can take it.
KEEP_ALIVE_S = 0.1


@click.command(
    "pub",
    epilog=examples(
        "manycore topic pub /chatter std_msgs/msg/String 'data: hello'",
        "manycore topic pub --once /chatter std_msgs/msg/String 'data: hello'",
        "manycore topic pub -r 10 /pose geometry_msgs/msg/PoseStamped '{header: auto}'",
        "manycore topic pub --once --stdin /chatter std_msgs/msg/String < message.yaml",
        "manycore topic pub --yaml-file echoed.yaml /chatter std_msgs/msg/String",
    ),
)
@click.argument("topic", shell_complete=complete_topics)
@click.argument("type_name", metavar="TYPE", shell_complete=complete_types_of_topic)
@values_argument()
@click.option(
    "--yaml-file",
    "file",
    type=click.Path(dir_okay=False, exists=True, path_type=Path),
    help="Publish the messages of a YAML file in turn, as printed by `topic echo`.",
)
@click.option(
    "-r",
    "--rate",
    "rate_hz",
    metavar="N",
    type=FiniteRange(min=MIN_RATE),
    default=1.0,
    show_default=True,
    help="Messages per second.",
)
@click.option("-1", "--once", is_flag=True, help="Publish one message and exit.")
@click.option(
    "-t",
    "--times",
    type=WholeRange(0),
    default=0,
    metavar="N",
    help="Publish N messages and exit.",
)
@number_option(
    "-p",
    "--print",
    "shown",
    within=(0, None),
    default=1,
    metavar="N",
    help="Print every Nth message.",
)
@click.option(
    "-w",
    "--wait-matching-subscriptions",
    "wanted",
    type=WholeRange(0),
    metavar="N",
    help="Wait for N matching subscriptions; default: 1 with --once and --times, else 0.",
)
@click.option(
    "--max-wait-time-secs",
    "timeout_s",
    metavar="S",
    type=Seconds(),
    help="Give up waiting after S seconds.",
)
@number_option(
    "--keep-alive",
    "keep_alive_s",
    within=(0, None),
    default=KEEP_ALIVE_S,
    metavar="S",
    help="Keep the publisher alive S seconds after the last message.",
)
@click.option("-n", "--node-name", metavar="NAME", help="Name of the publishing node.")
@qos_options
@talking_options
@platform_option
def command(
    topic: str,
    type_name: str,
    values: str | None,
    file: Path | None,
    rate_hz: float,
    once: bool,
    times: int,
    shown: int,
    wanted: int | None,
    timeout_s: float | None,
    keep_alive_s: float,
    node_name: str | None,
    qos: QosOptions,
    sim_time: bool,
    platform: str,
) -> None:
    """Publish messages of TYPE on TOPIC.

    VALUES are YAML; other fields have their defaults. `auto` for a header and `now` for a time
    stand for the time of publishing.
    """
    exclude(("--yaml-file", file is not None), ("VALUES", values is not None))
    exclude(("--once", once), ("--times", times > 0))
    times = 1 if once else times
    wanted = int(times > 0) if wanted is None else wanted
    if timeout_s is not None and not wanted:
        raise click.UsageError(
            "--max-wait-time-secs requires --wait-matching-subscriptions, --once or --times."
        )
    message_type = load_type(type_name)
    given = read_values(file) if file else [parse_values(values or DEFAULTS)]
    for fields in given:
        message_of(message_type, fields, Time())
    is_endless = not (times or file)
    with tool_node(platform, node_name, sim_time=sim_time, until_ctrl_c=is_endless) as node:
        publisher = node.create_publisher(message_type, topic, qos.profile())
        wait_for_subscriptions(node, publisher, wanted, timeout_s)
        echo("publisher: beginning loop")
        turns = given if file else repeat(given[0])  # messages of a file once each
        for fields, number in zip(turns, _ticks(node, 1 / rate_hz, times), strict=False):
            message = message_of(message_type, fields, node.get_clock().now().to_msg())
            if shown and number % shown == 0:
                echo(f"publishing #{number}: {message!r}\n")
            publisher.publish(message)
        time.sleep(keep_alive_s)


def _ticks(node: Any, period_s: float, times: int) -> Iterator[int]:
    """Yield 1, 2, ... once per period, `times` in all; forever if that is 0."""

    def now_s() -> float:
        return float(node.get_clock().now().nanoseconds * 1e-9)

    number, due_s = 0, now_s()
    while not times or number < times:
        while (left_s := due_s - now_s()) > 0:
            spin_once(node, left_s)
        number += 1
        due_s += period_s
        yield number
