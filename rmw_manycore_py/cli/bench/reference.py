# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""`manycore bench reference`."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import click

from rmw_manycore_py.bench.reference.question import reference_question
from rmw_manycore_py.bench.reference.setups import MESSAGES, Wanted
from rmw_manycore_py.bench.reference.system import Nodes
from rmw_manycore_py.cli.bench.answer import answer
from rmw_manycore_py.cli.bench.options import bench_options
from rmw_manycore_py.cli.common.options import examples

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
    help="Native nodes, which show the middleware, or unmodified rclpy nodes.",
)
@click.option(
    "--message",
    type=click.Choice(list(MESSAGES)),
    default="4k",
    show_default=True,
    help="Size of all messages.",
)
@click.option(
    "--crunch-ms",
    default=0.0,
    show_default=True,
    type=click.FloatRange(0, 1000),
    help="CPU time that each callback works for.",
)
@click.option(
    "--duration",
    "duration_s",
    default=20.0,
    show_default=True,
    type=click.FloatRange(1),
    help="Seconds that each contender is measured for in a round.",
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
    """Run the 24 nodes of the Autoware reference system, one process each.

    Latency of the hot path, drops, jitter, CPU, memory, start-up and throughput; also beside a
    load of one CPU, and on mappings that are good and bad. With --output, what the last node
    printed is written as the reference system's own report scripts read it.
    """
    wanted = Wanted(nodes, message, crunch_ms, duration_s)
    answer([reference_question(wanted, output)], output=output, **options)
