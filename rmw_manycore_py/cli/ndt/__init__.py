# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""`manycore ndt`."""

from __future__ import annotations

import click

from rmw_manycore_py.cli.common.group import LazyGroup

VERBS = {
    verb: f"rmw_manycore_py.cli.ndt.{verb}:command"
    for verb in ("simulate", "map", "replay", "overlay")
}


@click.group("ndt", cls=LazyGroup, commands_at=VERBS)
def command() -> None:
    """Prepare and test NDT scan matching.

    Recordings, maps and off-loading.
    """
