# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""Run the questions of a bench, judge its goals, print and write the report."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path

import click
from rich.console import Console

from rmw_manycore_py.bench.machine import machine_header
from rmw_manycore_py.bench.plot import plot
from rmw_manycore_py.bench.question import Question, Run
from rmw_manycore_py.bench.relations import Relation
from rmw_manycore_py.bench.session import usable_cpus
from rmw_manycore_py.bench.summary import Goal, Result, judge
from rmw_manycore_py.cli.bench.report import Report
from rmw_manycore_py.cli.common.printing import echo
from rmw_manycore_py.errors import ManycoreError
from rmw_manycore_py.picture.plotting import load_figure

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
    """Measure the questions, judge their goals, then print or write the report."""
    if with_plot and output is None:
        raise click.UsageError("--plot requires --output DIRECTORY")
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
        echo(report.as_json())
    else:
        report.print()
    if output is not None:
        _write(questions, report, output, with_plot, progress)
    if report.failures:
        raise ManycoreError("not measured:\n" + "\n".join(report.failures))


def _measure(questions: Sequence[Question], run: Run) -> Report:
    machine = machine_header()
    results: list[Result] = []
    goals: list[Goal] = []
    relations: list[Relation] = []
    for question in questions:
        found = question.measure(run)
        results += found
        goals += question.goals
        relations += question.relations(found)
    if not results and not run.failures:
        raise click.UsageError(f"--only {_quoted(run.only)} is in no QUESTION: CONTENDER")
    placements = {
        "CPUs": f"first {run.cpus[0]}, second {run.cpus[1]}",
        **{f"placement of {question.name}": question.placement for question in questions},
    }
    return Report(machine, placements, results, judge(results, goals), run.failures, relations)


def _quoted(only: tuple[str, ...]) -> str:
    return " or ".join(f"'{part}'" for part in only)


def _write(
    questions: Sequence[Question], report: Report, output: Path, with_plot: bool, progress: Console
) -> None:
    written = report.write(output)
    if with_plot:
        written.append(output / "plot.svg")
        plot(report.results, written[-1])
        for question in questions:
            written += question.draw(report.results, output)
    for path in written:
        progress.print(f"wrote {path}")
