# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""`manycore trace start`."""

from __future__ import annotations

import click

from rmw_manycore_py.cli.common.completion import complete_nodes
from rmw_manycore_py.cli.common.options import examples, number_option, platform_option
from rmw_manycore_py.cli.common.view import require_platform
from rmw_manycore_py.native import _transport
from rmw_manycore_py.native.errors import translate_native_errors


@click.command(
    "start",
    epilog=examples("manycore trace start", "manycore trace start --node /talker --cluster 2"),
)
@click.option(
    "--cluster",
    "clusters",
    multiple=True,
    type=click.IntRange(1, 64),
    help="Trace only this cluster.",
)
@click.option(
    "--node",
    "nodes",
    multiple=True,
    shell_complete=complete_nodes,
    help="Trace only this node (full name).",
)
@number_option(
    "--events",
    within=(1, 1 << 24),
    default=1 << 18,
    help="Ring size of each thread, in events of 32 bytes.",
)
@click.option("--discard", is_flag=True, help="Discard an earlier unsaved trace.")
@platform_option
def command(
    clusters: tuple[int, ...], nodes: tuple[str, ...], events: int, discard: bool, platform: str
) -> None:
    """Start tracing all processes of a platform.

    Processes that join later are traced as well.
    """
    require_platform(platform)
    with translate_native_errors():
        _transport.start_trace(
            platform, clusters=clusters, nodes=nodes, events=events, discard=discard
        )
