# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""The answers to the questions of a bench: measured, judged, printed and written."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path

import click
from rich.console import Console

from rmw_manycore_py.bench.machine import machine_header
from rmw_manycore_py.bench.plot import plot
from rmw_manycore_py.bench.question import Question, Run
from rmw_manycore_py.bench.session import usable_cpus
from rmw_manycore_py.bench.summary import Goal, Result, judge
from rmw_manycore_py.cli.bench.report import Report
from rmw_manycore_py.figures import load_figure

QUICK_SHARE = 0.05


def answer(
    questions: Sequence[Question],
    *,
    quick: bool,
    rounds: int,
    only: tuple[str, ...],
    as_json: bool,
    output: Path | None,
    with_plot: bool,
) -> None:
    """Measure, judge the goals, and print or write what came out."""
    if with_plot and output is None:
        raise click.UsageError("--plot needs --output, the directory to write to")
    if with_plot:
        load_figure()
    progress = Console(stderr=True)
    with progress.status("bench") as status:
        run = Run(
            cpus=usable_cpus(),
            rounds=1 if quick else rounds,
            share=QUICK_SHARE if quick else 1.0,
            only=only,
            note=status.update,
        )
        report = _measure(questions, run)
    if as_json:
        click.echo(report.as_json())
    else:
        report.print()
    if output is not None:
        _write(report, output, with_plot, progress)


def _measure(questions: Sequence[Question], run: Run) -> Report:
    machine = machine_header()
    results: list[Result] = []
    goals: list[Goal] = []
    for question in questions:
        results += question.measure(run)
        goals += question.goals
    placements = {
        "CPUs": f"first {run.cpus[0]}, second {run.cpus[1]}",
        **{f"placement of {question.name}": question.placement for question in questions},
    }
    return Report(machine, placements, results, judge(results, goals))


def _write(report: Report, output: Path, with_plot: bool, progress: Console) -> None:
    for path in report.write(output):
        progress.print(f"wrote {path}")
    if with_plot:
        path = output / "plot.svg"
        plot(report.results, path)
        progress.print(f"wrote {path}")
