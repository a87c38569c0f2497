# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""`manycore service`."""

from __future__ import annotations

import click

from rmw_manycore_py.cli.common.group import LazyGroup
from rmw_manycore_py.cli.common.options import hidden_group_option

VERBS = {
    verb: f"rmw_manycore_py.cli.service.{verb}:command"
    for verb in ("list", "info", "type", "find", "call", "echo")
}


@click.group("service", cls=LazyGroup, commands_at=VERBS)
@hidden_group_option("--include-hidden-services")
def command() -> None:
    """List, call and introspect services."""
