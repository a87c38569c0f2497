# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""`manycore bench noc`."""

from __future__ import annotations

from typing import Any

import click

from rmw_manycore_py.bench.question import Question
from rmw_manycore_py.cli.bench.answer import answer
from rmw_manycore_py.cli.bench.options import bench_options, model_option
from rmw_manycore_py.cli.common.options import examples
from rmw_manycore_py.papers.thesis.noc import host, model
from rmw_manycore_py.papers.thesis.noc.cases import SIZES, checked_sizes
from rmw_manycore_py.papers.thesis.noc.figures import figures
from rmw_manycore_py.papers.thesis.noc.routes import chosen, routes
from rmw_manycore_py.platform.topology import usable_cpus

_EXAMPLES = examples(
    "manycore bench noc -o build/noc --plot",
    "manycore bench noc --model bostan --quick",
    "manycore bench noc --size 4096 --size 65536 --cpus 0,1",
)


@click.command("noc", epilog=_EXAMPLES)
@model_option
@click.option(
    "--size",
    "sizes",
    type=int,
    multiple=True,
    default=SIZES,
    show_default="100 B to 1 MB",
    metavar="BYTES",
    help="Size of the data; may be repeated.",
)
@click.option(
    "--cpus",
    metavar="SENDER,RECEIVER[,UC]",
    help="Host CPUs of the only route; default: one of each kind that the machine has.",
)
@bench_options
def command(
    model_name: str | None, sizes: tuple[int, ...], cpus: str | None, **options: Any
) -> None:
    """Measure transfers between clusters (thesis, 4.1).

    The thesis on the NoC of the MPPA-256. Tx and UC, from DDR and SMEM, on each route: latency
    of 1,000 runs, box plots (figures 4.2 to 4.7), and which of the thesis' relations hold. With
    --model, also whether they follow from the structure of the chip or from unpublished
    numbers.
    """
    answer([_question(model_name, checked_sizes(sizes), cpus)], **options)


def _question(model_name: str | None, sizes: tuple[int, ...], cpus: str | None) -> Question:
    if model_name is None:
        placements = chosen(cpus, usable_cpus()) if cpus else routes(usable_cpus())
        drawn = figures(host.setting_of(placements), sizes, "this machine")
        return host.question(sizes, placements, drawn)
    if cpus:
        raise click.UsageError("--cpus is for this machine, not for --model")
    return model.question(sizes, figures(model.SETTING, sizes, "model of Bostan"))
