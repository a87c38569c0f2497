# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""`manycore param`."""

from __future__ import annotations

import click

from rmw_manycore_py.cli.common.group import LazyGroup

VERBS = {
    verb: f"rmw_manycore_py.cli.param.{verb}:command"
    for verb in ("list", "get", "set", "delete", "describe", "dump", "load")
}


@click.group("param", cls=LazyGroup, commands_at=VERBS)
def command() -> None:
    """Get, set and manage the parameters of nodes."""
