# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""`manycore bag`, for those who know `ros2 bag`."""

from __future__ import annotations

import click

from rmw_manycore_py.cli.common.group import LazyGroup

VERBS = {
    "info": "rmw_manycore_py.cli.bag.info:command",
    "record": "rmw_manycore_py.cli.topic.record:command",
    "play": "rmw_manycore_py.cli.topic.play:command",
}


@click.group("bag", cls=LazyGroup, commands_at=VERBS)
def command() -> None:
    """Look at recordings; `record` and `play` are those of `manycore topic`."""
