# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""`manycore bench memory`."""

from __future__ import annotations

from typing import Any

import click

from rmw_manycore_py.bench import memory
from rmw_manycore_py.cli.bench.answer import answer
from rmw_manycore_py.cli.bench.options import bench_options
from rmw_manycore_py.cli.common.options import examples


@click.command("memory", epilog=examples("manycore bench memory --quick"))
@bench_options
def command(**options: Any) -> None:
    """Measure the memory of platform, cluster and node."""
    answer([memory.QUESTION], **options)
