# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""Options shared by the verbs of `manycore bench`."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path

import click

from rmw_manycore_py.cli.common.duration import duration_option
from rmw_manycore_py.cli.common.options import number_option

DEFAULT_ROUNDS = 5

Body = Callable[..., None]

model_option = click.option(
    "--model",
    "model_name",
    type=click.Choice(["bostan"]),
    help="Ask a simulated Kalray MPPA-256 Bostan instead of this machine.",
)


def bench_options(body: Body) -> Body:
    """Add the options on how to measure and how to report."""
    options = [
        click.option(
            "--quick", is_flag=True, help="Run one short round, to check that everything works."
        ),
        number_option(
            "--rounds",
            within=(1, None),
            default=DEFAULT_ROUNDS,
            help="Times to measure everything.",
        ),
        click.option(
            "--only",
            multiple=True,
            help="Run only contenders with this text in QUESTION: CONTENDER.",
        ),
        click.option("--json", "as_json", is_flag=True, help="Print JSON instead of tables."),
        click.option(
            "-o",
            "--output",
            type=click.Path(file_okay=False, path_type=Path),
            help="Directory to write report.json, results.csv and samples.csv to.",
        ),
        click.option("--plot", "with_plot", is_flag=True, help="Also write plot.svg to --output."),
    ]
    for option in reversed(options):
        body = option(body)
    return body


def mapping_runs_options(*, min_mappings: int, repetitions: int) -> Callable[[Body], Body]:
    """Return a decorator that adds the options on random mappings and their runs."""
    options = [
        number_option(
            "--mappings",
            within=(min_mappings, None),
            default=20,
            help="Number of random mappings.",
        ),
        number_option(
            "--repetitions", within=(1, None), default=repetitions, help="Runs of each mapping."
        ),
        duration_option(10.0, "Length of a run.", endless=False),
        number_option(
            "--seed", within=(0, None), default=1, help="Seed of mappings and predictions."
        ),
        click.option(
            "-o",
            "--output",
            required=True,
            type=click.Path(file_okay=False, path_type=Path),
            help="Directory of profiles, mappings and runs; an interrupted start resumes there.",
        ),
    ]

    def decorate(body: Body) -> Body:
        for option in reversed(options):
            body = option(body)
        return body

    return decorate
