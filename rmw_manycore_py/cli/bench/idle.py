# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""`manycore bench idle`."""

from __future__ import annotations

from typing import Any

import click

from rmw_manycore_py.bench import idle
from rmw_manycore_py.cli.bench.answer import answer
from rmw_manycore_py.cli.bench.options import bench_options
from rmw_manycore_py.cli.common.options import examples, number_option

DEFAULT_NODES = 100


@click.command(
    "idle", epilog=examples("manycore bench idle --nodes 20", "manycore bench idle --quick")
)
@number_option("--nodes", within=(1, None), default=DEFAULT_NODES, help="Idle nodes.")
@bench_options
def command(nodes: int, **options: Any) -> None:
    """Measure CPU time and wake-ups of idle nodes."""
    answer([idle.question(nodes)], **options)
