# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""`manycore bench matrix`."""

from __future__ import annotations

from typing import Any

import click

from rmw_manycore_py.cli.bench.answer import answer
from rmw_manycore_py.cli.bench.options import bench_options, model_option
from rmw_manycore_py.cli.common.options import examples
from rmw_manycore_py.papers.thesis.matrix import host, model
from rmw_manycore_py.papers.thesis.matrix.cases import LARGE, SMALL, cases
from rmw_manycore_py.papers.thesis.matrix.figures import figures

_EXAMPLES = examples(
    "manycore bench matrix -o build/matrix --plot",
    "manycore bench matrix --model bostan",
    "manycore bench matrix --n 280 --only cached",
)


@click.command("matrix", epilog=_EXAMPLES)
@model_option
@click.option(
    "--n",
    "sizes",
    type=int,
    multiple=True,
    default=(SMALL, LARGE),
    show_default=True,
    metavar="ROWS",
    help="Rows of a square float32 matrix; all figures for the smallest, off-loading for each.",
)
@bench_options
def command(model_name: str | None, sizes: tuple[int, ...], **options: Any) -> None:
    """Measure matrix products as in the thesis, 4.2.

    The thesis on the NoC of the MPPA-256. In DDR and SMEM, cached and not, over threads, and
    off-loaded to four clusters: 1,000 runs, box plots (figures 4.9 to 4.12), and which of the
    thesis' relations hold. With --model, also whether they follow from the structure of the
    chip or from unpublished numbers.
    """
    asked = cases(sizes)
    if model_name is None:
        answer([host.question(asked, figures(asked, "this machine"))], **options)
    else:
        answer([model.question(asked, figures(asked, "model of Bostan"))], **options)
