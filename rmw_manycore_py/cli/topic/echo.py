# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""`manycore topic echo`, printed as `ros2 topic echo` prints."""

from __future__ import annotations

import json
from collections.abc import Callable
from typing import Any

import click
import yaml

from rmw_manycore_py.cli.common.message_text import SHOWN_LENGTH, Shown, to_csv, to_plain, to_yaml
from rmw_manycore_py.cli.common.options import examples, platform_option
from rmw_manycore_py.cli.topic.listening import Listener
from rmw_manycore_py.cli.topic.message_part import message_filter, part_of
from rmw_manycore_py.cli.topic.outside import OutsideListener
from rmw_manycore_py.cli.topic.qos_options import QosOptions, qos_request_options


@click.command(
    "echo",
    epilog=examples(
        "manycore topic echo /chatter",
        "manycore topic echo --once /chatter std_msgs/msg/String",
        "manycore topic echo /pose --field pose.position --csv",
        "manycore topic echo /chatter --filter 'm.data.endswith(\"0\")'",
        "manycore topic echo --outside /chatter",
        "manycore topic echo /chatter --json | jq .data",
    ),
)
@click.argument("topic")
@click.argument("type_name", metavar="[TYPE]", required=False)
@click.option("--once", is_flag=True, help="End after the first message.")
@click.option("--timeout", "timeout_s", type=float, metavar="S", help="End after S seconds.")
@click.option("--field", default="", metavar="PATH", help="Print only this part.")
@click.option("--filter", "expression", metavar="EXPR", help="Print only what it holds for, as m.")
@click.option("--csv", "style", flag_value="csv", help="Print values with commas between them.")
@click.option("--flow-style", "style", flag_value="flow", help="Print each array in one line.")
@click.option("--json", "style", flag_value="json", help="Print each as a line of JSON, in full.")
@click.option("--raw", "style", flag_value="raw", help="Print the bytes of each message.")
@click.option("-f", "--full-length", is_flag=True, help="Shorten nothing.")
@click.option(
    "-l",
    "--truncate-length",
    type=click.IntRange(0),
    default=SHOWN_LENGTH,
    show_default=True,
    help="What is shown of strings and arrays.",
)
@click.option("--no-arr", "no_arrays", is_flag=True, help="Name arrays without their elements.")
@click.option("--no-str", "no_strings", is_flag=True, help="Print only the lengths of strings.")
@click.option(
    "-i", "--include-message-info", "with_info", is_flag=True, help="Print times and numbers."
)
@click.option("--no-lost-messages", "silent", is_flag=True, help="Do not tell of lost messages.")
@click.option("--outside", is_flag=True, help="Listen in the DDS domain $ROS_DOMAIN_ID instead.")
@qos_request_options
@platform_option
def command(
    topic: str,
    type_name: str | None,
    platform: str,
    qos: QosOptions,
    once: bool,
    timeout_s: float | None,
    field: str,
    expression: str | None,
    style: str | None,
    full_length: bool,
    truncate_length: int,
    no_arrays: bool,
    no_strings: bool,
    with_info: bool,
    silent: bool,
    outside: bool,
) -> None:
    """Print the messages of TOPIC. TYPE is needed only while nobody uses the topic."""
    shown = Shown(None if full_length else truncate_length, not no_arrays, not no_strings)
    text, fulfils = _writer(style, shown), message_filter(expression)

    def heard(message: Any, info: dict[str, Any]) -> None:
        part = message if style == "raw" else part_of(message, field)
        if not fulfils(part):
            return
        if with_info and style == "json":
            click.echo(json.dumps({"info": info, "message": to_plain(part)}))
        else:
            click.echo((_info_text(info, style) if with_info else "") + text(part))
        if once:
            listener.stop()

    listener: Listener | OutsideListener
    if outside:
        listener = OutsideListener(topic, type_name, heard, raw=style == "raw", qos=qos)
    else:
        listener = Listener(
            platform,
            topic,
            type_name,
            heard,
            lost=None if silent or style == "json" else _tell_lost,
            raw=style == "raw",
            qos=qos,
        )
    listener.run(timeout_s)


def _info_text(info: dict[str, Any], style: str | None) -> str:
    """Return times (ns since 1970) and sequence numbers of a message, to stand before it."""
    if style == "csv":
        return "".join(f"{value}," for value in info.values())
    if style == "raw":
        return f"---Got new message, message info:---\n{info}\n---Message data:---\n"
    return f"{yaml.safe_dump(info)}---\n"


def _tell_lost(status: Any) -> None:
    click.echo(
        f"A message was lost!!!\n\ttotal count change:{status.total_count_change}"
        f"\n\ttotal count: {status.total_count}---"
    )


def _writer(style: str | None, shown: Shown) -> Callable[[Any], str]:
    writers: dict[str | None, Callable[[Any], str]] = {
        "csv": lambda part: to_csv(part, shown),
        "json": lambda part: json.dumps(to_plain(part)),
        "raw": lambda data: f"{data}\n---",
        "flow": lambda part: f"{to_yaml(part, shown, flow_style=True)}---",
    }
    return writers.get(style, lambda part: f"{to_yaml(part, shown)}---")
