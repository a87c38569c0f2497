# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""`manycore bench view`."""

from __future__ import annotations

from typing import Any

import click

from rmw_manycore_py.bench import view
from rmw_manycore_py.cli.bench.answer import answer
from rmw_manycore_py.cli.bench.options import bench_options


@click.command("view")
@bench_options
def command(**options: Any) -> None:
    """Measure the cost of `manycore view`.

    With 500 nodes and 1,000 active topics.
    """
    answer([view.QUESTION], **options)
