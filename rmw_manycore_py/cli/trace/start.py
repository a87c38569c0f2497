# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""`manycore trace start`."""

from __future__ import annotations

import click

from rmw_manycore_py import _transport
from rmw_manycore_py.cli.common.options import examples, platform_option
from rmw_manycore_py.cli.common.view import require_platform
from rmw_manycore_py.native_errors import translate_native_errors


@click.command(
    "start",
    epilog=examples("manycore trace start", "manycore trace start --node /talker --cluster 2"),
)
@click.option(
    "--cluster", "clusters", multiple=True, type=click.IntRange(1, 64), help="Only this cluster."
)
@click.option("--node", "nodes", multiple=True, help="Only this node, by its full name.")
@click.option(
    "--events",
    type=click.IntRange(1, 1 << 24),
    default=1 << 18,
    show_default=True,
    help="Events that each thread keeps until they are saved, of 32 bytes.",
)
@click.option("--discard", is_flag=True, help="Throw an earlier trace away that was not saved.")
@platform_option
def command(
    clusters: tuple[int, ...], nodes: tuple[str, ...], events: int, discard: bool, platform: str
) -> None:
    """Record from now on what the processes of a platform do, those that join later included."""
    require_platform(platform)
    with translate_native_errors():
        _transport.start_trace(
            platform, clusters=clusters, nodes=nodes, events=events, discard=discard
        )
