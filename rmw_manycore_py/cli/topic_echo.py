# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""`manycore topic echo`, printed as `ros2 topic echo` prints."""

from __future__ import annotations

import json
from typing import Any

import click

from rmw_manycore_py.cli.listening import Listener
from rmw_manycore_py.cli.message_text import to_plain, to_yaml
from rmw_manycore_py.cli.options import examples, platform_option


@click.command(
    "echo",
    epilog=examples(
        "manycore topic echo /chatter",
        "manycore topic echo --once /chatter std_msgs/msg/String",
        "manycore topic echo /chatter --json | jq .data",
    ),
)
@click.argument("topic")
@click.argument("type_name", metavar="[TYPE]", required=False)
@click.option("--once", is_flag=True, help="End after the first message.")
@click.option("--json", "as_json", is_flag=True, help="Print each message as a line of JSON.")
@platform_option
def command(topic: str, type_name: str | None, platform: str, once: bool, as_json: bool) -> None:
    """Print the messages of TOPIC, long strings and arrays shortened except in JSON.

    TYPE is needed only while nobody uses the topic.
    """

    def heard(message: Any) -> None:
        if as_json:
            click.echo(json.dumps(to_plain(message)))
        else:
            click.echo(f"{to_yaml(message)}---")
        if once:
            listener.stop()

    listener = Listener(platform, topic, type_name, heard)
    listener.run()
