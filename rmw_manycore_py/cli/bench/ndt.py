# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""`manycore bench ndt`."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import click

from rmw_manycore_py.bench.ndt import (
    accuracy,
    alignments,
    basin,
    gaps,
    lost,
    node,
    passes,
    split,
    trust,
)
from rmw_manycore_py.cli.bench.answer import answer
from rmw_manycore_py.cli.bench.options import bench_options
from rmw_manycore_py.cli.common.options import examples


@click.command(
    "ndt",
    epilog=examples("manycore bench ndt --quick", "manycore bench ndt --only node -o build/node"),
)
@click.option(
    "--pclomp",
    type=click.Path(exists=True, file_okay=False, path_type=Path),
    help="Checkout of ndt_omp to include; PCL is included if libpcl-dev is installed.",
)
@bench_options
def command(pclomp: Path | None, **options: Any) -> None:
    """Measure scan matching beside its peers.

    PCL, pclomp, small_gicp and Open3D; also over workers. Also measures the convergence basin,
    the rates of wrong poses believed and right poses refused, closed loops through gaps without
    scans and through a tunnel, scans without a guess in a large map, and the whole node: beside CPU
    load, with large scans, with new maps, and after a kill.
    """
    own = [split.QUESTION, basin.QUESTION, trust.QUESTION, gaps.QUESTION, lost.QUESTION]
    own += [accuracy.QUESTION, node.QUESTION]
    answer([passes.question(pclomp), alignments.question(pclomp), *own], **options)
