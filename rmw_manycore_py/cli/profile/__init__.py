# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""`manycore profile`."""

from __future__ import annotations

import click

from rmw_manycore_py.cli.common.group import LazyGroup
from rmw_manycore_py.cli.common.options import examples

VERBS = {
    "import": "rmw_manycore_py.cli.profile.import_:command",
    "record": "rmw_manycore_py.cli.profile.record:command",
    "show": "rmw_manycore_py.cli.profile.show:command",
}


@click.group(
    "profile",
    cls=LazyGroup,
    commands_at=VERBS,
    epilog=examples(
        "manycore profile record talker_listener --duration 30",
        "manycore profile import trace_directory -o app.profile.json",
        "manycore profile show app.profile.json",
    ),
)
def command() -> None:
    """Record, import and show application profiles.

    Callbacks with their execution times, triggers and publications.
    """
