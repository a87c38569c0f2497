# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""`manycore pause`."""

from __future__ import annotations

import click

from rmw_manycore_py.cli.common.holding import ask_for_time
from rmw_manycore_py.cli.common.options import examples, platform_option


@click.command("pause", epilog=examples("manycore pause", "manycore pause --platform domain-3"))
@platform_option
def command(platform: str) -> None:
    """Pause the virtual time of a run.

    The nodes that compute go on until they wait. `manycore step` and `manycore resume` let time go
    on. Only for runs in virtual time.
    """
    ask_for_time(platform, "pause", waits=True)
