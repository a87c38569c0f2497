# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""`manycore bench trace`."""

from __future__ import annotations

from typing import Any

import click

from rmw_manycore_py.bench import trace
from rmw_manycore_py.cli.bench.answer import answer
from rmw_manycore_py.cli.bench.options import bench_options


@click.command("trace")
@bench_options
def command(**options: Any) -> None:
    """Measure the overhead of tracing.

    Disabled and enabled, and the time to save a trace.
    """
    answer([trace.QUESTION], **options)
