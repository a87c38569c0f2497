# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""`manycore bench scale`."""

from __future__ import annotations

from typing import Any

import click

from rmw_manycore_py.bench import scale
from rmw_manycore_py.cli.bench.answer import answer
from rmw_manycore_py.cli.bench.options import bench_options


@click.command("scale")
@bench_options
def command(**options: Any) -> None:
    """Measure scaling over the threads of a process and the endpoints of a topic."""
    answer([scale.QUESTION], **options)
