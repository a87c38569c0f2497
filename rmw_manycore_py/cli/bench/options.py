# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""The options of every verb of `manycore bench`."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path

import click

DEFAULT_ROUNDS = 5

Body = Callable[..., None]


def bench_options(body: Body) -> Body:
    """Add how to measure, and the form of the report."""
    options = [
        click.option("--quick", is_flag=True, help="One short round: does everything run?"),
        click.option("--rounds", default=DEFAULT_ROUNDS, show_default=True, type=click.IntRange(1)),
        click.option("--only", multiple=True, help="Only those with this in QUESTION: CONTENDER."),
        click.option("--json", "as_json", is_flag=True, help="Print JSON instead of tables."),
        click.option(
            "-o",
            "--output",
            type=click.Path(file_okay=False, path_type=Path),
            help="Write report.json, results.csv and samples.csv to this directory.",
        ),
        click.option("--plot", "with_plot", is_flag=True, help="Write plot.svg there as well."),
    ]
    for option in reversed(options):
        body = option(body)
    return body
