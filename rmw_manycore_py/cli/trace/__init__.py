# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""`manycore trace`."""

from __future__ import annotations

import click

from rmw_manycore_py.cli.common.group import LazyGroup
from rmw_manycore_py.cli.common.options import examples

VERBS = {
    verb: f"rmw_manycore_py.cli.trace.{verb}:command"
    for verb in ("start", "stop", "status", "save", "latency", "draw", "compare")
}


@click.group(
    "trace",
    cls=LazyGroup,
    commands_at=VERBS,
    epilog=examples(
        "manycore trace start", "manycore trace stop", "manycore trace save -o trace.json"
    ),
)
def command() -> None:
    """Trace messages and analyse their latency.

    Events of nodes, receive threads and messages.
    """
