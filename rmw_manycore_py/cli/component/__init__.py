# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""`manycore component`."""

from __future__ import annotations

import click

from rmw_manycore_py.cli.common.group import LazyGroup

VERBS = {
    verb: f"rmw_manycore_py.cli.component.{verb}:command"
    for verb in ("list", "load", "unload", "types", "standalone")
}


@click.group("component", cls=LazyGroup, commands_at=VERBS, until_ctrl_c=("standalone",))
def command() -> None:
    """List, load and unload components.

    Components run in component containers.
    """
