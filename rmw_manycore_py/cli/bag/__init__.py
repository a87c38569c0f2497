# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""`manycore bag`: the verbs of `ros2 bag`."""

from __future__ import annotations

from copy import copy

import click
from typing_extensions import override

from rmw_manycore_py.cli.common.group import LazyGroup

VERBS = {
    "info": "rmw_manycore_py.cli.bag.info:command",
    "record": "rmw_manycore_py.cli.topic.record:command",
    "play": "rmw_manycore_py.cli.topic.play:command",
}


class _Aliases(LazyGroup):
    """Shows the examples of `manycore topic` verbs as `manycore bag` ones."""

    @override
    def get_command(self, ctx: click.Context, cmd_name: str) -> click.Command | None:
        command = copy(super().get_command(ctx, cmd_name))
        if command is not None and command.epilog:
            command.epilog = command.epilog.replace("manycore topic", "manycore bag")
        return command


@click.group("bag", cls=_Aliases, commands_at=VERBS)
def command() -> None:
    """Inspect, record and play recordings.

    `record` and `play` are those of `manycore topic`.
    """
