# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""`manycore bench ros-lite`."""

from __future__ import annotations

from typing import Any

import click

from rmw_manycore_py.cli.bench.answer import answer
from rmw_manycore_py.cli.bench.options import bench_options
from rmw_manycore_py.cli.common.options import examples
from rmw_manycore_py.papers.roslite.bench.question import QUESTION


@click.command(
    "ros-lite",
    epilog=examples(
        "manycore bench ros-lite -o build/ros-lite --plot",
        "manycore bench ros-lite --rounds 1 --only drive:",
        "manycore bench ros-lite --only 'one pass' --only sending",
    ),
)
@bench_options
def command(**options: Any) -> None:
    """Measure ROS-lite's pipeline as ROS-lite does.

    Its figures 13 to 16 and table I. 1,000 scans before and after parallelization, the localizer
    split over 1 to 5 clusters of derivatives and 2 or 3 of radius search, what each node sends by
    each transfer, and the memory of pure_pursuit's cluster; which of the paper's relations hold.
    Takes half an hour, a quarter of an hour with --rounds 1.
    """
    answer([QUESTION], **options)
