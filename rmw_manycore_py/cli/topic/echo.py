# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""`manycore topic echo`, with the output format of `ros2 topic echo`."""

from __future__ import annotations

from typing import Any

import click
import yaml

from rmw_manycore_py.cli.common.completion import complete_topics, complete_types_of_topic
from rmw_manycore_py.cli.common.message_text import (
    Shown,
    is_message,
    to_csv,
    to_plain,
    to_yaml,
)
from rmw_manycore_py.cli.common.options import discovery_options, examples, platform_option
from rmw_manycore_py.cli.common.printing import echo, json_text
from rmw_manycore_py.cli.common.seconds import Seconds
from rmw_manycore_py.cli.common.shown_options import shown_options
from rmw_manycore_py.cli.topic.listening import Listener
from rmw_manycore_py.cli.topic.message_part import message_filter, part_of
from rmw_manycore_py.cli.topic.outside import OutsideListener
from rmw_manycore_py.cli.topic.qos_options import QosOptions, qos_request_options

_RAW_HEAD = "---Got new message, message info:---\n{}\n---Message data:---\n"


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
@click.argument("topic", shell_complete=complete_topics)
@click.argument(
    "type_name", metavar="[TYPE]", required=False, shell_complete=complete_types_of_topic
)
@click.option("--once", is_flag=True, help="Exit after the first message.")
@click.option(
    "--timeout",
    "timeout_s",
    type=Seconds(),
    metavar="S",
    help="Exit after S seconds.",
)
@click.option("--field", default="", metavar="PATH", help="Print only this field.")
@click.option(
    "--filter", "expression", metavar="EXPR", help="Print messages m for which EXPR is true."
)
@shown_options
@click.option("--raw", "style", flag_value="raw", help="Print the bytes of each message.")
@click.option(
    "-i",
    "--include-message-info",
    "with_info",
    is_flag=True,
    help="Print timestamps and sequence numbers.",
)
@click.option("--no-lost-messages", "silent", is_flag=True, help="Do not report lost messages.")
@click.option("--outside", is_flag=True, help="Subscribe in the DDS domain $ROS_DOMAIN_ID instead.")
@qos_request_options
@discovery_options
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
    shown: Shown,
    with_info: bool,
    silent: bool,
    outside: bool,
) -> None:
    """Print the messages of TOPIC. TYPE is needed only if the topic does not exist yet."""
    fulfils = message_filter(expression)

    def heard(message: Any, info: dict[str, Any]) -> None:
        part = message if style == "raw" else part_of(message, field)
        if not fulfils(part):
            return
        echo(_text(part, info if with_info else None, style, shown))
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
            lost=None if silent or style == "json" else _report_lost,
            raw=style == "raw",
            qos=qos,
        )
    listener.run(timeout_s, until_ctrl_c=not once)


def _text(part: Any, info: dict[str, Any] | None, style: str | None, shown: Shown) -> str:
    """Format a message or a field, after its timestamps (ns since 1970) and sequence numbers.

    A field that is no message is formatted by Python, as in ros2cli.
    """
    if style == "json":
        plain = to_plain(part)
        return json_text(plain if info is None else {"info": info, "message": plain})
    if style == "raw" or not is_message(part):
        return ("" if info is None else _RAW_HEAD.format(info)) + f"{part}\n---"
    if style == "csv":
        return "".join(f"{value}," for value in (info or {}).values()) + to_csv(part, shown)
    head = "" if info is None else f"{yaml.safe_dump(info)}---\n"
    return f"{head}{to_yaml(part, shown, flow_style=style == 'flow')}---"


def _report_lost(status: Any) -> None:
    echo(
        f"A message was lost!!!\n\ttotal count change:{status.total_count_change}"
        f"\n\ttotal count: {status.total_count}---"
    )
