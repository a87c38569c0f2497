# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""`manycore lifecycle`."""

from __future__ import annotations

import click

from rmw_manycore_py.cli.common.group import LazyGroup

VERBS = {
    verb: f"rmw_manycore_py.cli.lifecycle.{verb}:command"
    for verb in ("nodes", "list", "get", "set")
}


@click.group("lifecycle", cls=LazyGroup, commands_at=VERBS)
def command() -> None:
    """Query and change the states of lifecycle nodes."""
