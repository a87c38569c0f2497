# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""`manycore bench all`."""

from __future__ import annotations

from typing import Any

import click

from rmw_manycore_py.bench import idle, memory, rclpy_round_trip, startup
from rmw_manycore_py.cli.bench.answer import answer
from rmw_manycore_py.cli.bench.idle import DEFAULT_NODES
from rmw_manycore_py.cli.bench.options import bench_options
from rmw_manycore_py.cli.bench.rmw import QUESTIONS
from rmw_manycore_py.cli.common.options import examples

QUICK_NODES = 20


@click.command(
    "all",
    epilog=examples("manycore bench all --quick", "manycore bench all -o build/results --plot"),
)
@bench_options
def command(quick: bool, **options: Any) -> None:
    """Measure messages, start-up, idle nodes and memory.

    --quick takes about two minutes. The other benchmarks have verbs of their own.
    """
    nodes = QUICK_NODES if quick else DEFAULT_NODES
    others = [rclpy_round_trip.QUESTION, startup.QUESTION, idle.question(nodes), memory.QUESTION]
    answer([*QUESTIONS.values(), *others], quick=quick, **options)
