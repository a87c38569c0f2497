# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""`manycore interface`."""

from __future__ import annotations

import click

from rmw_manycore_py.cli.common.group import LazyGroup

VERBS = {
    verb: f"rmw_manycore_py.cli.interface.{verb}:command"
    for verb in ("build", "list", "package", "packages", "proto", "remove", "show")
}


@click.group("interface", cls=LazyGroup, commands_at=VERBS)
def command() -> None:
    """List, show and build types of messages.

    Messages, services and actions.
    """
