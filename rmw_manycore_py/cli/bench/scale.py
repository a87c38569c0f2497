# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""`manycore bench scale`."""

from __future__ import annotations

from typing import Any

import click

from rmw_manycore_py.bench import scale
from rmw_manycore_py.cli.bench.answer import answer
from rmw_manycore_py.cli.bench.options import bench_options
from rmw_manycore_py.cli.common.options import examples

_EXAMPLES = examples(
    "manycore bench scale -o build/scale --plot",
    "manycore bench scale --quick",
    "manycore bench scale --only 'until each topic has its subscription'",
    "manycore bench scale --only 'next in its process: manycore'",
)


@click.command("scale", epilog=_EXAMPLES)
@bench_options
def command(**options: Any) -> None:
    """Measure many threads, endpoints and nodes.

    How they slow each other down, beside Fast DDS. Curves over the threads of a process that wait
    by block, adaptive and spin; over composed rclpy nodes with each executor; over the
    endpoints of a topic and the messages that a publisher keeps; over nodes that follow /clock
    at 1 kHz; over clients of a service and of an action; and over nodes of a platform: start,
    joins, rest, publishing, reading the graph, and kills.

    --quick measures the first half of each curve. --only selects a curve by its first question.
    """
    answer([scale.QUESTION], **options)
