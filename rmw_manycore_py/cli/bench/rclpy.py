# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""`manycore bench rclpy`."""

from __future__ import annotations

from typing import Any

import click

from rmw_manycore_py.bench import rclpy_round_trip
from rmw_manycore_py.cli.bench.answer import answer
from rmw_manycore_py.cli.bench.options import bench_options
from rmw_manycore_py.cli.common.options import examples


@click.command("rclpy", epilog=examples("manycore bench rclpy --quick --json"))
@bench_options
def command(**options: Any) -> None:
    """Measure round trips between two rclpy nodes."""
    answer([rclpy_round_trip.QUESTION], **options)
