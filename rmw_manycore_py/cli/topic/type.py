# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""`manycore topic type`, with the output format of `ros2 topic type`."""

from __future__ import annotations

import click

from rmw_manycore_py.cli.common import view
from rmw_manycore_py.cli.common.completion import complete_topics
from rmw_manycore_py.cli.common.names import show_types
from rmw_manycore_py.cli.common.options import (
    discovery_options,
    examples,
    platform_option,
)


@click.command("type", epilog=examples("manycore topic type /chatter"))
@click.argument("topic", shell_complete=complete_topics)
@discovery_options
@platform_option
def command(topic: str, platform: str) -> None:
    """Print the type of TOPIC, including hidden topics."""
    show_types(view.topics(view.endpoints_on(platform), hidden=True), topic, "topic")
