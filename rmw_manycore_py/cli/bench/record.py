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
    """Measure losses of a recorder, timing of a player.

    The recorder at 100 MB/s.
    """
    answer([record.QUESTION], **options)
