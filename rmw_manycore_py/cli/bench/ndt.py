# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""`manycore bench ndt`."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import click

from rmw_manycore_py.bench.ndt import alignments, basin, node, passes, split, trust
from rmw_manycore_py.cli.bench.answer import answer
from rmw_manycore_py.cli.bench.options import bench_options


@click.command("ndt")
@click.option(
    "--pclomp",
    type=click.Path(exists=True, file_okay=False, path_type=Path),
    help="A checkout of ndt_omp, to let it take part; PCL does where libpcl-dev is installed.",
)
@bench_options
def command(pclomp: Path | None, **options: Any) -> None:
    """Scan matching beside PCL, pclomp, small_gicp and Open3D, over workers, and from far off.

    Also how many wrong poses are believed, and how many right ones refused; and the whole node
    beside load, with large scans, new maps, and after a kill.
    """
    own = [alignments.QUESTION, split.QUESTION, basin.QUESTION, trust.QUESTION]
    own.append(node.QUESTION)
    answer([passes.question(pclomp), *own], **options)
