# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""`manycore bench idle`."""

from __future__ import annotations

from typing import Any

import click

from rmw_manycore_py.bench import idle
from rmw_manycore_py.cli.bench.answer import answer
from rmw_manycore_py.cli.bench.options import bench_options

DEFAULT_NODES = 100


@click.command("idle")
@click.option(
    "--nodes", default=DEFAULT_NODES, show_default=True, type=click.IntRange(1), help="Idle nodes."
)
@bench_options
def command(nodes: int, **options: Any) -> None:
    """Measure CPU time and wake-ups of idle nodes."""
    answer([idle.question(nodes)], **options)
