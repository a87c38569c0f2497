# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""`manycore resume`."""

from __future__ import annotations

import click

from rmw_manycore_py.cli.common.holding import ask_for_time
from rmw_manycore_py.cli.common.options import examples, platform_option


@click.command("resume", epilog=examples("manycore resume", "manycore resume --platform domain-3"))
@platform_option
def command(platform: str) -> None:
    """Resume the virtual time of a run.

    After `manycore pause` or `manycore step`.
    """
    ask_for_time(platform, "resume", waits=False)
