# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""`manycore topic`."""

from __future__ import annotations

import click

from rmw_manycore_py.cli.common.group import LazyGroup
from rmw_manycore_py.cli.common.options import hidden_group_option

VERBS = {
    verb: f"rmw_manycore_py.cli.topic.{verb}:command"
    for verb in (
        *("list", "info", "type", "find", "echo", "pub", "hz", "bw", "delay"),
        *("record", "play"),
    )
}


@click.group("topic", cls=LazyGroup, commands_at=VERBS)
@hidden_group_option("--include-hidden-topics")
def command() -> None:
    """List, inspect, publish, record and play topics."""
