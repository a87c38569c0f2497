# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""`manycore bench record`."""

from __future__ import annotations

from typing import Any

import click

from rmw_manycore_py.bench import record
from rmw_manycore_py.cli.bench.answer import answer
from rmw_manycore_py.cli.bench.options import bench_options


@click.command("record")
@bench_options
def command(**options: Any) -> None:
    """Measure the losses of a recorder at 100 MB/s, and the timing error of a player."""
    answer([record.QUESTION], **options)
