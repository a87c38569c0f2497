# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""`manycore bridge CONFIG` and `manycore bridge status`."""

from __future__ import annotations

import click
from typing_extensions import override

from rmw_manycore_py.cli.common.group import LazyGroup
from rmw_manycore_py.cli.common.options import examples

VERBS = {
    "run": "rmw_manycore_py.cli.bridge.run:command",
    "status": "rmw_manycore_py.cli.bridge.status:command",
}


class _BridgeGroup(LazyGroup):
    """Treats a first argument that is no verb as a file to run."""

    @override
    def resolve_command(
        self, ctx: click.Context, args: list[str]
    ) -> tuple[str | None, click.Command | None, list[str]]:
        if args and args[0] not in VERBS:
            args = ["run", *args]
        return super().resolve_command(ctx, args)


@click.group(
    "bridge",
    cls=_BridgeGroup,
    commands_at=VERBS,
    until_ctrl_c=("run",),
    epilog=examples("manycore bridge run domain_bridge.yaml", "manycore bridge status"),
)
def command() -> None:
    """Bridge topics and services to other domains."""
