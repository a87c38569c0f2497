# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""`manycore bench reference`."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import click

from rmw_manycore_py.cli.bench.answer import answer
from rmw_manycore_py.cli.bench.options import bench_options
from rmw_manycore_py.cli.common.options import examples, number_option
from rmw_manycore_py.papers.reference_system.bench.question import reference_question
from rmw_manycore_py.papers.reference_system.bench.setups import MESSAGES, Wanted
from rmw_manycore_py.papers.reference_system.bench.system import Nodes

_EXAMPLES = examples(
    "manycore bench reference --rounds 1",
    "manycore bench reference --message 1m --only 'untouched: '",
    "manycore bench reference --nodes rclpy --crunch-ms 1 --duration 120 --rounds 1",
)


@click.command("reference", epilog=_EXAMPLES)
@click.option(
    "--nodes",
    type=click.Choice(["rcl", "rclpy"]),
    default="rcl",
    show_default=True,
    help="Native nodes, which isolate the middleware, or unmodified rclpy nodes.",
)
@click.option(
    "--message",
    type=click.Choice(list(MESSAGES)),
    default="4k",
    show_default=True,
    help="Size of all messages.",
)
@number_option(
    "--crunch-ms", within=(0, 1000), default=0.0, help="CPU time that each callback burns."
)
@number_option(
    "--duration",
    "duration_s",
    within=(1, None),
    default=20.0,
    help="Seconds per contender and round.",
)
@bench_options
def command(
    nodes: Nodes,
    message: str,
    crunch_ms: float,
    duration_s: float,
    output: Path | None,
    **options: Any,
) -> None:
    """Run the nodes of the Autoware reference system.

    24 nodes, one process each. Measures latency of the hot path, drops, jitter, CPU, memory,
    start-up and throughput, also beside one busy CPU and with good and bad mappings. With
    --output, also writes the output of the last node in the format that the report scripts of
    the reference system read.
    """
    wanted = Wanted(nodes, message, crunch_ms, duration_s)
    answer([reference_question(wanted, output)], output=output, **options)
