# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""`manycore bench`: the figures of rmw_manycore, measured here and now."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from pathlib import Path
from typing import Any

import click
from rich.console import Console

from rmw_manycore_py.bench import (
    bridge,
    fan_out,
    first_message,
    idle,
    memory,
    rclpy_round_trip,
    round_trip,
    startup,
    steady_state,
    throughput,
)
from rmw_manycore_py.bench.machine import machine_header
from rmw_manycore_py.bench.ndt import alignments, passes, split
from rmw_manycore_py.bench.plot import plot
from rmw_manycore_py.bench.question import Question, Run
from rmw_manycore_py.bench.report import Report
from rmw_manycore_py.bench.session import usable_cpus
from rmw_manycore_py.bench.summary import Goal, Result, judge
from rmw_manycore_py.figures import load_figure

RMW_QUESTIONS = {
    "round-trip": round_trip.QUESTION,
    "throughput": throughput.QUESTION,
    "fan-out": fan_out.QUESTION,
    "first-message": first_message.QUESTION,
    "steady-state": steady_state.QUESTION,
}
QUICK_SHARE = 0.05
QUICK_NODES = 20
DEFAULT_NODES = 100
DEFAULT_ROUNDS = 5

Body = Callable[..., None]


@click.group()
def bench() -> None:
    """Measure rmw_manycore beside Fast DDS and beside the machine itself."""


def _common_options(body: Body) -> Body:
    options = [
        click.option("--quick", is_flag=True, help="One short round: does everything run?"),
        click.option("--rounds", default=DEFAULT_ROUNDS, show_default=True, type=click.IntRange(1)),
        click.option("--only", multiple=True, help="Only contenders with this in their name."),
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


@bench.command("rmw")
@click.argument("questions", nargs=-1, type=click.Choice(list(RMW_QUESTIONS)))
@_common_options
def rmw_command(questions: tuple[str, ...], **options: Any) -> None:
    """Native programs over rmw_publish, rmw_wait and rmw_take; all QUESTIONS unless named."""
    _answer([RMW_QUESTIONS[name] for name in questions or RMW_QUESTIONS], **options)


@bench.command("rclpy")
@_common_options
def rclpy_command(**options: Any) -> None:
    """Round trips between two rclpy nodes."""
    _answer([rclpy_round_trip.QUESTION], **options)


@bench.command("startup")
@_common_options
def startup_command(**options: Any) -> None:
    """From the start of an rclpy process to its first message."""
    _answer([startup.QUESTION], **options)


@bench.command("idle")
@click.option("--nodes", default=DEFAULT_NODES, show_default=True, type=click.IntRange(1))
@_common_options
def idle_command(nodes: int, **options: Any) -> None:
    """CPU and wake-ups of nodes with nothing to do."""
    _answer([idle.question(nodes)], **options)


@bench.command("memory")
@_common_options
def memory_command(**options: Any) -> None:
    """Memory of the platform, of a cluster and of a node."""
    _answer([memory.QUESTION], **options)


@bench.command("ndt")
@click.option(
    "--pclomp",
    type=click.Path(exists=True, file_okay=False, path_type=Path),
    help="A checkout of ndt_omp, to let it take part; PCL does where libpcl-dev is installed.",
)
@_common_options
def ndt_command(pclomp: Path | None, **options: Any) -> None:
    """Scan matching beside PCL, pclomp, small_gicp and Open3D, and over workers."""
    questions = [passes.question(pclomp), alignments.QUESTION, split.QUESTION]
    _answer(questions, **options)


@bench.command("bridge")
@_common_options
def bridge_command(**options: Any) -> None:
    """Round trips of a node outside with one inside, and what an idle bridge costs."""
    _answer([bridge.QUESTION], **options)


@bench.command("all")
@_common_options
def all_command(quick: bool, **options: Any) -> None:
    """Answer all questions; with --quick that takes about two minutes."""
    nodes = QUICK_NODES if quick else DEFAULT_NODES
    others = [rclpy_round_trip.QUESTION, startup.QUESTION, idle.question(nodes), memory.QUESTION]
    _answer([*RMW_QUESTIONS.values(), *others], quick=quick, **options)


def _answer(
    questions: Sequence[Question],
    *,
    quick: bool,
    rounds: int,
    only: tuple[str, ...],
    as_json: bool,
    output: Path | None,
    with_plot: bool,
) -> None:
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
