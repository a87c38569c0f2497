# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""`manycore bench bridge`."""

from __future__ import annotations

from typing import Any

import click

from rmw_manycore_py.bench import bridge
from rmw_manycore_py.cli.bench.answer import answer
from rmw_manycore_py.cli.bench.options import bench_options
from rmw_manycore_py.cli.common.options import examples


@click.command(
    "bridge",
    epilog=examples("manycore bench bridge --quick", "manycore bench bridge --only 'another host'"),
)
@bench_options
def command(**options: Any) -> None:
    """Measure the bridge.

    Round trips, images to another host, and an idle bridge.
    """
    answer([bridge.QUESTION], **options)
