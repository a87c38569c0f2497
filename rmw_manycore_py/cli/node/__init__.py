# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""`manycore node`."""

from __future__ import annotations

import click

from rmw_manycore_py.cli.common.group import LazyGroup

VERBS = {verb: f"rmw_manycore_py.cli.node.{verb}:command" for verb in ("list", "info")}


@click.group("node", cls=LazyGroup, commands_at=VERBS)
def command() -> None:
    """List nodes and show their interfaces."""
