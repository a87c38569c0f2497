# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""`manycore action`."""

from __future__ import annotations

import click

from rmw_manycore_py.cli.common.group import LazyGroup

VERBS = {
    verb: f"rmw_manycore_py.cli.action.{verb}:command"
    for verb in ("list", "info", "type", "send_goal")
}


@click.group("action", cls=LazyGroup, commands_at=VERBS)
def command() -> None:
    """List actions and send them goals."""
