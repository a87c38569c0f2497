# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""`manycore map`."""

from __future__ import annotations

import click

from rmw_manycore_py.cli.common.group import LazyGroup

VERBS = {verb: f"rmw_manycore_py.cli.map.{verb}:command" for verb in ("init", "check", "show")}


@click.group("map", cls=LazyGroup, commands_at=VERBS)
def command() -> None:
    """Create, check and show mapfiles."""
