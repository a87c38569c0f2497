# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""`manycore bench startup`."""

from __future__ import annotations

from typing import Any

import click

from rmw_manycore_py.bench import startup
from rmw_manycore_py.cli.bench.answer import answer
from rmw_manycore_py.cli.bench.options import bench_options


@click.command("startup")
@bench_options
def command(**options: Any) -> None:
    """Measure the time to the first message.

    From the start of an rclpy process.
    """
    answer([startup.QUESTION], **options)
